// The borders of a surface that is not closed.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::cave {

/// A closed line of open edges. Its vertices stand in the order in which a surface that closes it, and faces
/// the same side as the mesh there, runs round it.
struct BoundaryLoop {
  std::vector<std::uint32_t> vertices;      // each once
  core::Vec3 centre = core::Vec3::Zero();   // of the line
  core::Vec3 normal = core::Vec3::UnitZ();  // unit, of the plane in which it encloses the greatest area
  double area_m2 = 0, diameter_m = 0;       // area in that plane; twice the greatest distance from the centre
};

/// Open edges are those of an odd number of triangles. An even number of them meets at every vertex, so that
/// they always form loops; where more than two meet, loops touch. Sorted by area, the largest first.
std::vector<BoundaryLoop> boundary_loops(const TriangleMesh& mesh);

/// The loop with the vertex nearest to a place; null if there is no loop.
const BoundaryLoop* nearest_loop(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                                 const core::Vec3& place);
/// The loop whose centre is nearest to a direction (unit) as seen from a place; null if there is no loop.
const BoundaryLoop* loop_towards(const std::vector<BoundaryLoop>& loops, const core::Vec3& from,
                                 const core::Vec3& direction);

/// "1.9 m across, 2.8 m², around 12.0 0.0 1.5"
std::string size_and_place(const BoundaryLoop& loop);

/// "; the open edges nearest to it are a loop of 24, 1.9 m across, 2.8 m², around 12.0 0.0 1.5", and how to
/// close it; of null, that no edge is open. Continues a sentence about a hole.
std::string hole_text(const BoundaryLoop* loop);

}  // namespace karst::cave
