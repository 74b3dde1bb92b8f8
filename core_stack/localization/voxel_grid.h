// Statistics of points in cubic voxels: count, sum and second moments of the points in each.
//
// They give the surface near a place without keeping single points: the mean and the scatter of the 3x3x3
// voxels around it, taken together. The window is three voxels wide and never off centre by more than half a
// voxel.
//
// Voxels lie in one array in order of creation. A hash table with linear probing finds them: it holds the
// keys next to the indices, and four voxels above one another begin in one cache line.
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

/// Mean and principal axes of the points of a window; the deviations along the axes are ascending.
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

  /// A voxel accepts at most `max_points` points.
  VoxelGrid(double voxel_m, std::int64_t max_points);

  Key key_of(const Vec3f& p) const;
  /// Adds points; their coordinates must be below a million voxels.
  void insert(std::span<const Vec3f> points);
  /// Adds the contents of a grid whose voxels have the same size or half the size.
  void merge(const VoxelGrid& other);
  void clear();
  /// Visits the next `count` voxels in turn and drops those whose centres are farther than `radius_m` from
  /// `centre` along any axis, so that the work is spread over many calls.
  void forget_some(const Vec3& centre, double radius_m, std::size_t count);
  /// Drops the voxels farthest from `centre` until at most `max_voxels` are left (fewer if several are
  /// equally far).
  void keep_nearest(const Vec3& centre, std::size_t max_voxels);

  /// Null if the voxel holds no point.
  const Voxel* find(Key key) const;
  Vec3 centre_of(Key key) const;
  /// The 27 voxels of the window around a voxel, null where empty, x fastest.
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
  std::size_t slot_of(Key key) const;  // slot of the key, or the slot it would get
  std::size_t home_of(Key key) const;  // slot at which the search for the key starts
  VoxelSums& made(Key key);            // creates an empty voxel if needed
  void erase(std::size_t voxel);
  void rebuild(std::size_t slots);

  double voxel_m_;
  float per_m_, max_points_;
  std::vector<Voxel> voxels_;
  std::vector<Slot> table_;  // size is a power of two
  std::size_t turn_ = 0;     // the voxel that forget_some visits next
};

/// If there are fewer points than `least`, only their number is set.
Surface surface_of(const VoxelGrid& grid, VoxelGrid::Key centre, const VoxelGrid::Window& window,
                   double least);

/// Means of the points of two grids in the same window, over the voxels that hold points of both. The weight
/// of a voxel in both means is the smaller of the two grids' counts. Both means thus cover the same part of
/// the rock at the same density: curvature and partial views shift both means alike.
struct MeanPair {
  double points = 0;  // 0: no voxel holds points of both grids
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
};
MeanPair means_of(const VoxelGrid& grid, VoxelGrid::Key centre, const VoxelGrid::Window& a,
                  const VoxelGrid::Window& b);

}  // namespace karst::core
