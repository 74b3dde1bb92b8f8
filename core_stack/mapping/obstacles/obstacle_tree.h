// KD-tree of obstacles: occupied cells, and unknown cells that touch free ones.
#pragma once
#include <memory>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// Built from the map inside a box (world frame), then immutable. Distances in metres to cell centres.
class ObstacleTree {
 public:
  ObstacleTree(const VoxelMap& map, const Vec3& low, const Vec3& high);
  ~ObstacleTree();
  ObstacleTree(ObstacleTree&&) noexcept;
  ObstacleTree& operator=(ObstacleTree&&) noexcept;

  std::size_t size() const;
  /// Distance from p to the nearest obstacle cell's centre; +inf if there is none.
  double distance(const Vec3& p) const;
  /// Like distance, and returns the nearest centre. False if there is none.
  bool nearest(const Vec3& p, Vec3& center, double& distance_m) const;
  /// True if some obstacle centre is nearer than radius_m (cheaper than the distance).
  bool any_within(const Vec3& p, double radius_m) const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace karst::core
