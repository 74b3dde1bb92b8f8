#include "sdk/cave_from_cloud/thin_out.h"

#include <algorithm>
#include <cstdint>

#include "core_stack/localization/voxel_grid.h"
#include "core_stack/mapping/obstacles/point_tree.h"
#include "sdk/cave_from_cloud/signed_sets.h"

namespace karst::from_cloud {

using core::Vec3f;

PointCloud thinned(const PointCloud& cloud, double voxel_m) {
  constexpr std::int64_t kMostPoints = 1 << 20;  // of a voxel: floats count so far
  core::VoxelGrid grid(voxel_m, kMostPoints);
  grid.insert(cloud.points);
  PointCloud thin;
  thin.origin = cloud.origin;
  thin.points.reserve(grid.voxels().size());
  for (const core::VoxelGrid::Voxel& v : grid.voxels())
    thin.points.push_back(
        (grid.centre_of(v.key) + (v.sums.sum / v.sums.points).cast<double>()).cast<float>());
  if (!cloud.has_normals()) return thin;
  thin.normals.assign(thin.points.size(), Vec3f::Zero());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const core::VoxelGrid::Voxel* voxel = grid.find(grid.key_of(cloud.points[i]));
    thin.normals[static_cast<std::size_t>(voxel - grid.voxels().data())] += cloud.normals[i];
  }
  for (Vec3f& n : thin.normals) {
    const float length = n.norm();
    n = length > 1e-3f ? Vec3f(n / length) : Vec3f(Vec3f::Zero());
  }
  return thin;
}

PointCloud without_lonely(const PointCloud& cloud, double gap_m, std::size_t least) {
  const core::PointTree tree(cloud.points);
  SignedSets groups(cloud.points.size());
  for (std::uint32_t i = 0; i < cloud.points.size(); ++i)
    for (const std::uint32_t j : tree.within(cloud.points[i].cast<double>(), gap_m))
      if (j < i) groups.unite(i, j);
  PointCloud kept;
  kept.origin = cloud.origin;
  for (std::uint32_t i = 0; i < cloud.points.size(); ++i) {
    if (groups.size_of_set(i) < least) continue;
    kept.points.push_back(cloud.points[i]);
    if (cloud.has_normals()) kept.normals.push_back(cloud.normals[i]);
  }
  return kept;
}

double spacing_m(const PointCloud& cloud) {
  constexpr double kOnePoint_m = 0.05;
  constexpr std::size_t kSample = 2000, kFourthOther = 5;
  float reach_m = 0;
  for (const Vec3f& p : cloud.points) reach_m = std::max(reach_m, p.cwiseAbs().maxCoeff());
  PointCloud places{cloud.origin, cloud.points, {}};
  const core::PointTree tree(
      thinned(places, std::max(kOnePoint_m, 2 * static_cast<double>(reach_m) / kMostVoxels)).points);
  const std::vector<Vec3f>& points = tree.points();
  std::vector<double> distances_m;
  for (std::size_t i = 0; i < points.size(); i += points.size() / kSample + 1) {
    const std::vector<std::uint32_t> near = tree.nearest_few(points[i].cast<double>(), kFourthOther);
    distances_m.push_back(static_cast<double>((points[near.back()] - points[i]).norm()));
  }
  const auto middle = distances_m.begin() + static_cast<std::ptrdiff_t>(distances_m.size() / 2);
  std::nth_element(distances_m.begin(), middle, distances_m.end());
  return *middle;
}

}  // namespace karst::from_cloud
