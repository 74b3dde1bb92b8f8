// The rock around the vehicle, as its LiDAR saw it, in bounded memory.
//
// Surfaces are kept in a few grids, each twice as coarse as the one before: near the sensor, where points are
// dense, a small window follows the rock closely; far away only a large one holds enough points. Edges have a
// grid of their own. A sweep joins the map when it was taken at a new place (a keyframe): a vehicle that
// hovers, or comes back, adds nothing, so what it knows of a place keeps the error it had at first.
#pragma once
#include <vector>

#include "core_stack/common/options.h"
#include "core_stack/localization/voxel_grid.h"

namespace karst::core {

struct LocalMapOptions {
  double voxel_m = 0.15;                // of the finest grid of surfaces
  std::int64_t levels = 3;              // grids of surfaces
  double edge_voxel_m = 0.25;           // of the grid of edges
  double radius_m = 150;                // what is farther away along any axis is forgotten
  std::int64_t max_voxels = 1'000'000;  // of each grid, the farthest forgotten first
  std::int64_t max_points = 1000;       // of each voxel
  double keyframe_distance_m = 0.5;
};
void describe(OptionTable& t, LocalMapOptions& o);

/// A sweep's points, all as seen at one time; in the body frame or in the world.
struct Cloud {
  std::vector<Vec3f> edges;    // features
  std::vector<Vec3f> planes;   // features
  std::vector<Vec3f> surface;  // every point that is not on the border of what is seen
};
Cloud transformed(const Pose& T, const Cloud& cloud);

/// Grids of surfaces, each twice as coarse as the one before.
using Grids = std::vector<VoxelGrid>;
/// Makes `grids[first]` and coarser ones, as large as those of `like`, hold these points and no others.
void fill_grids(const std::vector<Vec3f>& points, const Grids& like, std::size_t first, Grids& grids);

class LocalMap {
 public:
  explicit LocalMap(const LocalMapOptions& options);

  bool empty() const { return keyframes_.empty(); }
  /// No keyframe lies within the keyframe distance.
  bool is_new_place(const Vec3& position) const;
  /// Adds a sweep taken at `position` and forgets what is too far from there.
  void insert(const Cloud& cloud_world, const Vec3& position);
  void clear();

  const VoxelGrid& edges() const { return edges_; }
  const Grids& surfaces() const { return surfaces_; }  // finest first
  std::size_t keyframes() const { return keyframes_.size(); }
  std::size_t voxels() const;
  std::size_t bytes() const;

 private:
  LocalMapOptions options_;
  VoxelGrid edges_;
  Grids surfaces_, scratch_;
  std::vector<Vec3> keyframes_;
};

}  // namespace karst::core
