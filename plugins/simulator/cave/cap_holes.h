// Closes the holes of a mesh.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "plugins/simulator/cave/boundary_loops.h"
#include "plugins/simulator/cave/ray_scene.h"

namespace karst::cave {

/// Triangles over the vertices of a loop, which face the same side as the mesh around it. By clipping ears in
/// the loop's plane (Meisters, Polygons have ears, 1975); a loop that crosses itself there gets a fan around
/// its centre, for which `mesh` gets one more vertex.
std::vector<std::array<std::uint32_t, 3>> cap_of(const BoundaryLoop& loop, TriangleMesh& mesh);

enum class LeftOpen {
  no,         // it was closed
  slit,       // its edges lie on one line, as where a corner meets the middle of an edge: nothing passes
  too_large,  // wider than the limit
  seam        // air of the cave on both sides: parts of the mesh meet there
};
/// What became of the loop.
constexpr auto names_of(LeftOpen) {
  using enum LeftOpen;
  return std::to_array<core::Named<LeftOpen>>(
      {{no, "closed"}, {slit, "slit"}, {too_large, "too_large"}, {seam, "seam"}});
}

struct CapOfLoop {
  BoundaryLoop loop;
  LeftOpen left = LeftOpen::no;
};

struct Capped {
  TriangleMesh mesh;
  std::vector<CapOfLoop> loops;  // the largest first
};

/// Closes each loop of open edges of at most `max_diameter_m`, unless it is a slit or a seam. Of a seam most
/// rays from either side of the loop's centre, a quarter of its diameter off, cross an odd number of
/// surfaces, as they do inside the cave only.
Capped cap_holes(const RayScene& scene, double max_diameter_m);

}  // namespace karst::cave
