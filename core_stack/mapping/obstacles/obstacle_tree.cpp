#include "core_stack/mapping/obstacles/obstacle_tree.h"

#include <limits>

#include "core_stack/mapping/obstacles/kd_points.h"
#include "core_stack/mapping/obstacles/obstacle_cells.h"

namespace karst::core {
namespace {

/// nanoflann result set: the nearest point within a bound; `first_will_do` stops at the first one found.
struct NearestWithin {
  using DistanceType = float;
  float bound;  // squared metres
  bool first_will_do;
  std::uint32_t index = 0;
  bool found = false;

  std::size_t size() const { return found ? 1 : 0; }
  bool full() const { return found; }
  float worstDist() const { return bound; }
  bool addPoint(float squared_distance, std::uint32_t i) {
    if (squared_distance >= bound) return true;
    bound = squared_distance;
    index = i;
    found = true;
    return !first_will_do;
  }
};

std::vector<Vec3f> obstacle_centers(const VoxelMap& map, const CellKey& low, const CellKey& high) {
  std::vector<Vec3f> points;
  for (const CellKey& k : obstacle_cells(map, low, high)) points.push_back(map.center_of(k).cast<float>());
  return points;
}

}  // namespace

struct ObstacleTree::Storage {
  enum class Wanted { nearest, any };
  KdPoints cloud;
  KdIndex index;

  explicit Storage(std::vector<Vec3f> points)
      : cloud{std::move(points)}, index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}

  NearestWithin search(const Vec3& p, double radius_m, Wanted wanted) const {
    NearestWithin result{static_cast<float>(radius_m * radius_m), wanted == Wanted::any};
    const Vec3f query = p.cast<float>();
    if (!cloud.points.empty() && query.allFinite())
      index.findNeighbors(result, query.data(), nanoflann::SearchParams());
    return result;
  }
};

ObstacleTree::ObstacleTree(const VoxelMap& map, const Vec3& low, const Vec3& high)
    : storage_(std::make_unique<Storage>(obstacle_centers(map, map.key_of(low), map.key_of(high)))) {}
ObstacleTree::~ObstacleTree() = default;
ObstacleTree::ObstacleTree(ObstacleTree&&) noexcept = default;
ObstacleTree& ObstacleTree::operator=(ObstacleTree&&) noexcept = default;

std::size_t ObstacleTree::size() const { return storage_->cloud.points.size(); }

double ObstacleTree::distance(const Vec3& p) const {
  Vec3 center;
  double distance_m = 0;
  return nearest(p, center, distance_m) ? distance_m : std::numeric_limits<double>::infinity();
}

bool ObstacleTree::nearest(const Vec3& p, Vec3& center, double& distance_m) const {
  const NearestWithin found =
      storage_->search(p, std::numeric_limits<double>::infinity(), Storage::Wanted::nearest);
  if (!found.found) return false;
  center = storage_->cloud.points[found.index].cast<double>();
  distance_m = (center - p).norm();
  return true;
}

bool ObstacleTree::any_within(const Vec3& p, double radius_m) const {
  return storage_->search(p, radius_m, Storage::Wanted::any).found;
}

}  // namespace karst::core
