// The rock around the vehicle as statistics of points, in bounded memory.
//
// Space is cut into cubic voxels; each holds the number, the sum and the outer products of the points in it.
// The surface near a place is read from the 3x3x3 voxels around it taken together: their mean, and the
// principal axes of their scatter. So a plane or a line is fitted to a window three voxels wide that is never
// off centre by more than half a voxel, however many points were inserted, and neither noise nor number of
// points has to be traded against memory. Where points are sparse, far away from the sensor, a second level
// with larger voxels answers.
//
// Voxels live in blocks of 4x4x4 and a table of blocks. Blocks beyond the radius around the vehicle are
// dropped, the farthest first if there are still more than `max_blocks`.
#pragma once
#include <array>
#include <span>
#include <unordered_map>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/options.h"

namespace karst::core {

struct LocalMapOptions {
  double voxel_m = 0.25;
  double coarse_voxel_m = 0.75;  // of the second level
  double radius_m = 60;
  std::int64_t max_blocks = 60000;
  std::int64_t max_points = 200;  // a voxel; later ones are not added: the oldest have drifted least
};
void describe(OptionTable& t, LocalMapOptions& o);

/// Mean and principal axes of the points around a place; `deviation_m` along the axes, ascending.
struct Surface {
  double points = 0;
  Vec3 mean = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // columns
  Vec3 deviation_m = Vec3::Zero();
};

/// Sums of points relative to the voxel's centre.
struct VoxelSums {
  float points = 0;
  Vec3f sum = Vec3f::Zero();
  std::array<float, 6> products{};  // xx xy xz yy yz zz
};

/// One level.
class VoxelLevel {
 public:
  VoxelLevel(double voxel_m, std::int64_t max_points);
  void insert(std::span<const Vec3f> points_world);
  /// Of the window around `p`; with fewer than `least` points in it only their number is set.
  Surface surface_near(const Vec3& p, double least) const;
  /// Drops blocks whose centres are farther than `radius_m` in any axis, then the farthest above
  /// `max_blocks`.
  void roll(const Vec3& centre, double radius_m, std::size_t max_blocks);

  std::size_t blocks() const { return blocks_.size(); }
  std::size_t voxels() const;
  std::size_t bytes() const;
  double voxel_m() const { return voxel_m_; }
  Eigen::Vector3i voxel_of(const Vec3& p) const { return (p / voxel_m_).array().floor().cast<int>(); }

 private:
  static constexpr int kEdge = 4;
  struct Block {
    Eigen::Vector3i corner;  // its first voxel
    std::array<VoxelSums, kEdge * kEdge * kEdge> voxels;
  };
  static std::uint64_t key_of(const Eigen::Vector3i& block);
  const Block* find(const Eigen::Vector3i& block) const;
  void drop(std::size_t i);

  double voxel_m_;
  float max_points_;
  std::vector<Block> blocks_;  // in the order of their making
  std::unordered_map<std::uint64_t, std::uint32_t> index_;
};

}  // namespace karst::core
