// Local map: the surrounding rock as seen by the LiDAR, in bounded memory.
//
// Surfaces are kept in a few grids, each twice as coarse as the one before: near the sensor, where points are
// dense, a small window follows the rock closely; far away only a large one holds enough points. Edges have a
// grid of their own. A sweep is added to the map if it was taken at a new place (a keyframe). A vehicle that
// hovers or returns adds nothing, so that a place keeps the error that it had when it was first mapped.
#pragma once
#include <vector>

#include "core_stack/common/options.h"
#include "core_stack/localization/voxel_grid.h"

namespace karst::core {

struct LocalMapOptions {
  double voxel_m = 0.15;                // edge of a voxel of the finest surface grid
  std::int64_t levels = 3;              // number of surface grids
  double edge_voxel_m = 0.25;           // edge of a voxel of the edge grid
  double radius_m = 150;                // voxels farther away along any axis are dropped
  std::int64_t max_voxels = 1'000'000;  // of each grid; the farthest voxels are dropped first
  std::int64_t max_points = 1000;       // of each voxel
  double keyframe_distance_m = 0.5;
};
void describe(OptionTable& t, LocalMapOptions& o);

/// A sweep's points, all motion-compensated to one time; in the body frame or in the world frame.
struct Cloud {
  std::vector<Vec3f> edges;    // features
  std::vector<Vec3f> planes;   // features
  std::vector<Vec3f> surface;  // all points that do not lie at an occlusion boundary
};
Cloud transformed(const Pose& T, const Cloud& cloud);

/// Surface grids, each twice as coarse as the one before.
using Grids = std::vector<VoxelGrid>;
/// Fills `grids[first]` and coarser ones, with the voxel sizes of `like`, with exactly these points.
void fill_grids(const std::vector<Vec3f>& points, const Grids& like, std::size_t first, Grids& grids);

class LocalMap {
 public:
  explicit LocalMap(const LocalMapOptions& options);

  bool empty() const { return keyframes_.empty(); }
  /// Whether no keyframe lies within the keyframe distance. World frame.
  bool is_new_place(const Vec3& position) const;
  /// Adds a sweep taken at `position` (world frame) and drops the voxels that are too far from there.
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
