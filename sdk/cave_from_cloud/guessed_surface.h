// Which surface was not measured, but filled in by the reconstruction.
#pragma once
#include <cstddef>
#include <vector>

#include "core_stack/mapping/obstacles/point_tree.h"
#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::from_cloud {

/// For each triangle, whether all its corners are farther than `beyond_m` from every measured point.
std::vector<bool> guessed_triangles(const cave::TriangleMesh& mesh, const core::PointTree& measured,
                                    double beyond_m);

/// Guessed triangles that hang together by their corners.
struct GuessedPatch {
  double area_m2 = 0, diameter_m = 0;  // twice the greatest distance of a corner from the centre
  core::Vec3 centre = core::Vec3::Zero();
};

struct GuessedSurface {
  double area_m2 = 0, whole_m2 = 0;   // whole: of the mesh
  std::vector<GuessedPatch> patches;  // the largest first
};
GuessedSurface guessed_surface(const cave::TriangleMesh& mesh, const std::vector<bool>& guessed);

}  // namespace karst::from_cloud
