// The reference for a map: the points of a scanned cloud, or points sampled on a cave's mesh.
#pragma once
#include "core_stack/common/geometry.h"
#include "plugins/simulator/cave/triangle_mesh.h"
#include "sdk/evaluation/accuracy/evaluate_run.h"

namespace karst::evaluation {

/// Points spread evenly over the triangles that touch the box, enlarged by `margin_m`; deterministic. Throws
/// InputError naming `name` if there would be more than 60 million.
std::vector<core::Vec3f> sample_surface(const cave::TriangleMesh& mesh, double points_per_m2,
                                        const Eigen::AlignedBox3d& box, double margin_m,
                                        const std::string& name);

/// Reads a cave .info, a mesh (.stl, .obj, .dae, .ply with faces), or a cloud (.pcd, .ply, .bin). A mesh is
/// sampled only within 5 m around `points`: an error beyond counts as at least that.
MapReference open_reference(const std::string& file, double points_per_m2,
                            const std::vector<core::Vec3>& points);

/// The map of a run or a file: occupied cells of .bt and .ot, points of .pcd and .ply.
std::vector<core::Vec3> read_map_points(const std::string& file);

}  // namespace karst::evaluation
