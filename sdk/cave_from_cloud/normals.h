// Normals of points that have none: direction by the plane through the neighbours.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core_stack/mapping/obstacles/point_tree.h"

namespace karst::from_cloud {

/// For each point the nearest ones, itself first, all the same number.
class Neighbours {
 public:
  /// The tree must hold at least `each` points.
  Neighbours(const core::PointTree& tree, std::size_t each);
  std::span<const std::uint32_t> of(std::size_t point) const { return {&all_[point * each_], each_}; }

 private:
  std::size_t each_;
  std::vector<std::uint32_t> all_;
};

/// For each point the direction in which its neighbours vary least (principal component analysis), of either
/// sign.
std::vector<core::Vec3f> plane_normals(const std::vector<core::Vec3f>& points, const Neighbours& neighbours);

/// Share of the points whose normal is not opposed to that of the nearest other point.
double agreement(const std::vector<core::Vec3f>& normals, const Neighbours& neighbours);

}  // namespace karst::from_cloud
