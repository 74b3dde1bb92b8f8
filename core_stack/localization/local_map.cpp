#include "core_stack/localization/local_map.h"

#include <algorithm>
#include <limits>

namespace karst::core {

namespace {
constexpr std::size_t kTurns = 16;  // keyframes over which the distance check visits every voxel once
}

void describe(OptionTable& t, LocalMapOptions& o) {
  t.add("voxel", o.voxel_m, "m", 0.03, 5,
        "edge of the finest voxels; surfaces are fitted to windows of 3x3x3");
  t.add("levels", o.levels, 1, 6, "grids of surfaces, each twice as coarse as the one before");
  t.add("edge_voxel", o.edge_voxel_m, "m", 0.03, 5, "edge of the voxels of edges");
  t.add("radius", o.radius_m, "m", 5, 500, "rock farther away along any axis is forgotten");
  t.add("max_voxels", o.max_voxels, 1000, 50'000'000,
        "voxels of a grid at most, the farthest forgotten first");
  t.add("max_points", o.max_points, 10, 100'000, "points of a voxel at most; the oldest have drifted least");
  t.add("keyframe_distance", o.keyframe_distance_m, "m", 0.05, 20,
        "a sweep joins the map if it was taken so far from all that did");
}

Cloud transformed(const Pose& T, const Cloud& cloud) {
  const Eigen::Matrix3f R = T.orientation.toRotationMatrix().cast<float>();
  const Vec3f t = T.position.cast<float>();
  const auto moved = [&](const std::vector<Vec3f>& points) {
    std::vector<Vec3f> out(points.size());
    std::transform(points.begin(), points.end(), out.begin(),
                   [&](const Vec3f& p) -> Vec3f { return R * p + t; });
    return out;
  };
  return {moved(cloud.edges), moved(cloud.planes), moved(cloud.surface)};
}

void fill_grids(const std::vector<Vec3f>& points, const Grids& like, std::size_t first, Grids& grids) {
  while (grids.size() < like.size())
    grids.emplace_back(like[grids.size()].voxel_m(), std::numeric_limits<std::int64_t>::max());
  for (std::size_t i = first; i < grids.size(); ++i) grids[i].clear();
  grids[first].insert(points);
  for (std::size_t i = first + 1; i < grids.size(); ++i) grids[i].merge(grids[i - 1]);
}

LocalMap::LocalMap(const LocalMapOptions& options)
    : options_(options), edges_(options.edge_voxel_m, options.max_points) {
  double voxel_m = options.voxel_m;
  for (std::int64_t i = 0; i < options.levels; ++i, voxel_m *= 2)
    surfaces_.emplace_back(voxel_m, options.max_points);
}

bool LocalMap::is_new_place(const Vec3& position) const {
  return std::none_of(keyframes_.begin(), keyframes_.end(),
                      [&](const Vec3& k) { return (k - position).norm() < options_.keyframe_distance_m; });
}

void LocalMap::insert(const Cloud& cloud_world, const Vec3& position) {
  edges_.insert(cloud_world.edges);
  fill_grids(cloud_world.surface, surfaces_, 0, scratch_);
  for (std::size_t i = 0; i < surfaces_.size(); ++i) surfaces_[i].merge(scratch_[i]);
  const auto most = static_cast<std::size_t>(options_.max_voxels);
  const auto forget = [&](VoxelGrid& g) {
    g.forget_some(position, options_.radius_m, g.voxels().size() / kTurns + 1);
    if (g.voxels().size() > most) g.keep_nearest(position, most - most / 10);  // leaves room for keyframes
  };
  forget(edges_);
  for (VoxelGrid& g : surfaces_) forget(g);
  std::erase_if(keyframes_,
                [&](const Vec3& k) { return (k - position).cwiseAbs().maxCoeff() > options_.radius_m; });
  keyframes_.push_back(position);
}

void LocalMap::clear() {
  edges_.clear();
  for (VoxelGrid& g : surfaces_) g.clear();
  keyframes_.clear();
}

std::size_t LocalMap::voxels() const {
  std::size_t n = edges_.voxels().size();
  for (const VoxelGrid& g : surfaces_) n += g.voxels().size();
  return n;
}

std::size_t LocalMap::bytes() const {
  std::size_t n = edges_.bytes() + keyframes_.capacity() * sizeof(Vec3);
  for (const VoxelGrid& g : surfaces_) n += g.bytes();
  return n;
}

}  // namespace karst::core
