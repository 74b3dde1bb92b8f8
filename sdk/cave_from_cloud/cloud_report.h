// What was read, left out, closed and guessed on the way from a cloud to a cave.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "plugins/simulator/cave/boundary_loops.h"
#include "sdk/cave_from_cloud/guessed_surface.h"
#include "sdk/cave_from_cloud/orient.h"

namespace karst::from_cloud {

enum class NormalsFrom { file, points };
constexpr auto names_of(NormalsFrom) {
  using enum NormalsFrom;
  return std::to_array<core::Named<NormalsFrom>>({{file, "file"}, {points, "points"}});
}

struct CloudReport {
  std::size_t points = 0, not_finite = 0, withheld = 0, without_normal = 0;  // of the file
  double spacing_m = 0, resolution_m = 0, guessed_beyond_m = 0;
  std::size_t thinned = 0;      // points after thinning to one a cell
  std::size_t lonely = 0;       // of those, left out because they are far from the others
  std::size_t off_surface = 0;  // of the others, farther from the cave's surface than `guessed_beyond_m`
  NormalsFrom normals = NormalsFrom::points;
  std::optional<Orientation> orientation;  // none: the signs are the file's
  double agreement = 0;                    // see agreement()
  std::size_t other_parts = 0;             // of the surface, left out
  double other_parts_m2 = 0;
  std::vector<cave::BoundaryLoop> holes;  // that the reconstruction left open, closed since
  GuessedSurface guessed;
  double volume_m3 = 0;
  std::vector<std::string> findings;  // what may be wrong, and what mends it
};

}  // namespace karst::from_cloud
