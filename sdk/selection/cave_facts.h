// What can be said of a cave without flying through it.
#pragma once
#include <optional>
#include <string>

#include "plugins/simulator/cave/ray_scene.h"
#include "sdk/evaluation/reachable/reachable.h"

namespace karst::selection {

struct MeshFacts {
  std::size_t triangles = 0;
  core::Vec3 low = core::Vec3::Zero(), high = core::Vec3::Zero();
  /// Edges that do not belong to exactly two triangles which run along them in opposite directions; corners
  /// at the same place count as one. None: the mesh is closed and consistent.
  std::size_t edges = 0, odd_edges = 0;
};
MeshFacts mesh_facts(const cave::TriangleMesh& mesh);

/// Of places the vehicle can fly through: the shorter of ten level lines through them from rock to rock, and
/// the plumb line. Tenth, fiftieth and ninetieth percentile.
struct PassageFacts {
  std::array<double, 3> width_m{}, height_m{};
};
PassageFacts passage_facts(const cave::RayScene& scene, const evaluation::Reachable& reachable);

}  // namespace karst::selection
