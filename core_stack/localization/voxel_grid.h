// Statistics of points in cubic voxels: number, sum and products of the points in each.
//
// From these the surface near a place is read without keeping a point: the mean and the scatter of the 3x3x3
// voxels around it, taken together. The window is three voxels wide and never off centre by more than half a
// voxel.
//
// Voxels lie in one array in the order of their making. A table with linear probing finds them: it holds the
// keys next to the indices, and four voxels above one another start in one cache line.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

/// Sums of points relative to the voxel's centre.
struct VoxelSums {
  float points = 0;
  Vec3f sum = Vec3f::Zero();
  std::array<float, 6> products{};  // xx xy xz yy yz zz
};

/// Mean and principal axes of the points of a window; deviations along the axes ascend.
struct Surface {
  double points = 0;
  Vec3 mean = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // columns
  Vec3 deviation_m = Vec3::Zero();
};

class VoxelGrid {
 public:
  /// Three coordinates of 21 bits each.
  using Key = std::uint64_t;
  struct Voxel {
    Key key;
    VoxelSums sums;
  };

  /// A voxel that holds `max_points` takes no more.
  VoxelGrid(double voxel_m, std::int64_t max_points);

  Key key_of(const Vec3f& p) const;
  /// Adds points with coordinates of less than a million voxels.
  void insert(std::span<const Vec3f> points);
  /// Adds what is in a grid of voxels as large, or of half the size.
  void merge(const VoxelGrid& other);
  void clear();
  /// Looks at the next `count` voxels in turn and drops those whose centres are farther than `radius_m` from
  /// `centre` along any axis: a little of the work at a time.
  void forget_some(const Vec3& centre, double radius_m, std::size_t count);
  /// Drops the voxels farthest from `centre` until at most `max_voxels` are left (fewer where several are
  /// equally far).
  void keep_nearest(const Vec3& centre, std::size_t max_voxels);

  /// Null if there is no point in it.
  const Voxel* find(Key key) const;
  Vec3 centre_of(Key key) const;
  /// The 27 voxels of the window around one, null where empty, x fastest.
  using Window = std::array<const VoxelSums*, 27>;
  Window window_around(Key key) const;

  double voxel_m() const { return voxel_m_; }
  const std::vector<Voxel>& voxels() const { return voxels_; }
  std::size_t bytes() const;

 private:
  struct Slot {
    Key key;
    std::uint32_t voxel;  // index + 1, 0: free
  };
  std::size_t slot_of(Key key) const;  // where it is, or where it would be
  std::size_t home_of(Key key) const;  // where the search for it starts
  VoxelSums& made(Key key);            // empty if it is new
  void erase(std::size_t voxel);
  void rebuild(std::size_t slots);

  double voxel_m_;
  float per_m_, max_points_;
  std::vector<Voxel> voxels_;
  std::vector<Slot> table_;  // as long as a power of two
  std::size_t turn_ = 0;     // the voxel that forget_some looks at next
};

/// With fewer points than `least` only their number is set.
Surface surface_of(const VoxelGrid& grid, VoxelGrid::Key centre, const VoxelGrid::Window& window,
                   double least);

/// Means of the points of two grids in the same window, over the voxels that hold points of both; each voxel
/// counts in both means as often as the grid with fewer points there can say. So both see the same part of
/// the rock at the same density: what is curved or seen in part shifts both means alike.
struct MeanPair {
  double points = 0;  // 0: no voxel holds points of both
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
};
MeanPair means_of(const VoxelGrid& grid, VoxelGrid::Key centre, const VoxelGrid::Window& a,
                  const VoxelGrid::Window& b);

}  // namespace karst::core
