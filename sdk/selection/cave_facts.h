// Facts about a cave that need no flight.
#pragma once
#include <optional>
#include <string>

#include "plugins/simulator/cave/ray_scene.h"
#include "sdk/evaluation/reachable/reachable.h"

namespace karst::selection {

struct MeshFacts {
  std::size_t triangles = 0;
  core::Vec3 low = core::Vec3::Zero(), high = core::Vec3::Zero();
  /// Corners at the same position count as one. Odd edges do not belong to exactly two triangles; of a closed
  /// mesh there are none. Flipped edges belong to two triangles that run along them in the same direction,
  /// that is, whose normals point to opposite sides.
  std::size_t edges = 0, odd_edges = 0, flipped_edges = 0;
};
MeshFacts mesh_facts(const cave::TriangleMesh& mesh);

/// Width and height at places the vehicle can fly through: the shortest of ten horizontal lines from rock to
/// rock, and the vertical one. Tenth, fiftieth and ninetieth percentile.
struct PassageFacts {
  std::array<double, 3> width_m{}, height_m{};
};
PassageFacts passage_facts(const cave::RayScene& scene, const evaluation::Reachable& reachable);

}  // namespace karst::selection
