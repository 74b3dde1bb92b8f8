#include "core_stack/mapping/obstacles/point_tree.h"

#include <algorithm>

#include "core_stack/mapping/obstacles/kd_points.h"

namespace karst::core {

struct PointTree::Storage {
  KdPoints cloud;
  KdIndex index;
  explicit Storage(std::vector<Vec3f> points)
      : cloud{std::move(points)}, index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}
};

PointTree::PointTree(std::vector<Vec3f> points) : storage_(std::make_unique<Storage>(std::move(points))) {}
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;

const std::vector<Vec3f>& PointTree::points() const { return storage_->cloud.points; }

std::optional<PointTree::Nearest> PointTree::nearest(const Vec3& p) const {
  const Vec3f query = p.cast<float>();
  if (points().empty() || !query.allFinite()) return std::nullopt;
  Nearest found{0, 0};
  float squared = 0;
  storage_->index.knnSearch(query.data(), 1, &found.index, &squared);
  found.distance_m = (points()[found.index].cast<double>() - p).norm();  // the tree's floats lose millimetres
  return found;
}

std::vector<std::uint32_t> PointTree::nearest_few(const Vec3& p, std::size_t count) const {
  const Vec3f query = p.cast<float>();
  if (count == 0 || points().empty() || !query.allFinite()) return {};
  std::vector<std::uint32_t> found(count);
  std::vector<float> squared(count);
  found.resize(storage_->index.knnSearch(query.data(), count, found.data(), squared.data()));
  return found;
}

std::vector<std::uint32_t> PointTree::within(const Vec3& p, double radius_m) const {
  const Vec3f query = p.cast<float>();
  std::vector<std::uint32_t> found;
  if (points().empty() || !query.allFinite()) return found;
  std::vector<std::pair<std::uint32_t, float>> matches;
  storage_->index.radiusSearch(query.data(), static_cast<float>(radius_m * radius_m), matches,
                               nanoflann::SearchParams());
  for (const auto& m : matches) found.push_back(m.first);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace karst::core
