// A KD-tree over points for nearest-neighbour and radius queries.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

class PointTree {
 public:
  struct Nearest {
    std::uint32_t index;
    double distance_m;
  };

  explicit PointTree(std::vector<Vec3f> points);
  ~PointTree();
  PointTree(PointTree&&) noexcept;

  const std::vector<Vec3f>& points() const;
  /// None if there are no points, or `p` is not finite.
  std::optional<Nearest> nearest(const Vec3& p) const;
  /// Indices of the `count` nearest points, the nearest first; fewer if there are no more.
  std::vector<std::uint32_t> nearest_few(const Vec3& p, std::size_t count) const;
  /// Indices of the points within the radius, in ascending order.
  std::vector<std::uint32_t> within(const Vec3& p, double radius_m) const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace karst::core
