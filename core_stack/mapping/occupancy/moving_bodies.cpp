#include "core_stack/mapping/occupancy/moving_bodies.h"

#include <algorithm>
#include <optional>

namespace karst::core {
namespace {

constexpr double kFarthest_m = 10.0;  // farther off, a small error of the attitude moves rock by a cell
constexpr double kMaxAcross_m = 1.0;  // of the returns from a vehicle
// With the cells beside it that it has left occupied while it was not known to move.
constexpr double kMaxTrail_m = 2.0;
constexpr std::size_t kFewestReturns = 5;
// Of the returns, those where space surely was free: what moves by less than a cell a scan has hit most
// of its cells before.
constexpr double kFewestInFree = 0.2;
constexpr float kSurelyFree = -1.1f;  // log-odds: passed in six scans
// More cells hit in free space, or more bodies, are dust or a wrong pose. This bounds the search, too.
constexpr std::size_t kMaxCells = 2000, kMaxBodies = 16;

/// A cell that the scan hits and that is not occupied.
struct HitCell {
  CellKey key;
  Vec3 sum = Vec3::Zero();  // of the returns in it
  std::size_t returns = 0;
  bool was_known = false, was_surely_free = false;
  int group = 0;  // that it belongs to; 0: none yet
};

HitCell* find(std::vector<HitCell>& cells, const CellKey& key) {
  const auto at = std::lower_bound(cells.begin(), cells.end(), key,
                                   [](const HitCell& c, const CellKey& k) { return c.key < k; });
  return at != cells.end() && at->key == key ? &*at : nullptr;
}

/// Sorted by key; none if too many are in free space.
std::vector<HitCell> hit_cells(const VoxelMap& map, std::span<const Ray> rays) {
  std::vector<std::pair<CellKey, Vec3f>> ends;
  for (const Ray& ray : rays) {
    if (!ray.hit || !((ray.end - ray.origin).norm() < kFarthest_m)) continue;  // NaN is left out, too
    const CellKey key = map.key_of(ray.end.cast<double>());
    if (map.at(key) != Cell::occupied) ends.emplace_back(key, ray.end);
  }
  std::stable_sort(ends.begin(), ends.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<HitCell> cells;
  for (const auto& [key, end] : ends) {
    if (cells.empty() || cells.back().key != key) {
      const std::optional<float> before = map.log_odds(key);
      cells.push_back(
          {.key = key, .was_known = before.has_value(), .was_surely_free = before.value_or(0) < kSurelyFree});
    }
    cells.back().sum += end.cast<double>();
    ++cells.back().returns;
  }
  const auto in_free =
      std::count_if(cells.begin(), cells.end(), [](const HitCell& c) { return c.was_surely_free; });
  if (static_cast<std::size_t>(in_free) > kMaxCells) cells.clear();
  return cells;
}

/// The mean of the hits near the cell: of a body that it is part of, about its middle.
Vec3 mean_near(const std::vector<HitCell>& cells, const HitCell& cell) {
  const Vec3 at = cell.sum / static_cast<double>(cell.returns);
  Vec3 sum = Vec3::Zero();
  double returns = 0;
  for (const HitCell& c : cells) {
    if (!c.was_surely_free || (c.sum / static_cast<double>(c.returns) - at).norm() > kMaxAcross_m) continue;
    sum += c.sum;
    returns += static_cast<double>(c.returns);
  }
  return sum / returns;
}

/// The smallest box around cells.
struct Box {
  CellKey low, high;
  void add(const CellKey& k) {
    low = {std::min(low.x, k.x), std::min(low.y, k.y), std::min(low.z, k.z)};
    high = {std::max(high.x, k.x), std::max(high.y, k.y), std::max(high.z, k.z)};
  }
  double across_m(double resolution_m) const {
    return resolution_m * std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  }
};

/// The shadow of a body as the sensor sees it.
struct Shadow {
  Vec3 sensor, body;
  bool contains(const Vec3& p) const {
    const Vec3 to_body = body - sensor, behind = p - body;
    const double along_m = behind.dot(to_body.normalized());
    return along_m > 0 && (behind - along_m * to_body.normalized()).norm() < kMaxAcross_m / 2;
  }
};

/// What touches `first`, hit or occupied, and of that the hits. No body if it is large, reaches into what was
/// not known, or has few hits where space was surely free: then it is rock, or may be. Behind a body
/// that comes straight at the sensor the cells that it has left stay occupied, as no ray passes them: what
/// lies in its shadow is not counted.
std::optional<Vec3> hanging(const VoxelMap& map, std::vector<HitCell>& cells, HitCell& first, int group,
                            const Vec3& sensor) {
  const Shadow shadow{sensor, mean_near(cells, first)};
  std::vector<CellKey> members{first.key}, occupied;
  Box all{first.key, first.key}, hit = all;
  Vec3 sum = Vec3::Zero();
  std::size_t returns = 0, in_free = 0;
  bool large = false;
  const auto take = [&](HitCell& cell) {
    cell.group = group;
    large = large || !cell.was_known;
    in_free += cell.was_surely_free ? cell.returns : 0;
    sum += cell.sum;
    returns += cell.returns;
    hit.add(cell.key);
  };
  const auto visit = [&](const CellKey& key) {
    if (HitCell* cell = find(cells, key)) {
      large = large || (cell->group != 0 && cell->group != group);  // of one that was left before its end
      if (cell->group != 0) return;
      take(*cell);
    } else {
      if (map.at(key) != Cell::occupied || shadow.contains(map.center_of(key))) return;
      const auto known = std::lower_bound(occupied.begin(), occupied.end(), key);
      if (known != occupied.end() && *known == key) return;
      occupied.insert(known, key);
    }
    all.add(key);
    members.push_back(key);
  };
  take(first);
  const double resolution_m = map.resolution_m();
  for (std::size_t i = 0; i < members.size() && !large; ++i) {
    for (int n = 0; n < 27; ++n) visit(members[i] + CellKey{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1});
    large = large || all.across_m(resolution_m) > kMaxTrail_m;
  }
  if (large || hit.across_m(resolution_m) > kMaxAcross_m || in_free < kFewestReturns ||
      kFewestInFree * static_cast<double>(returns) > static_cast<double>(in_free))
    return std::nullopt;
  return sum / static_cast<double>(returns);
}

}  // namespace

void leave_out(std::vector<Ray>& rays, std::span<const MovingBody> bodies) {
  for (const MovingBody& body : bodies) {
    const Vec3f center = body.position.cast<float>();
    const auto reach2 = static_cast<float>(body.radius_m * body.radius_m);
    for (Ray& ray : rays)
      if (ray.hit && (ray.end - center).squaredNorm() < reach2) ray.hit = false;
  }
}

std::vector<Vec3> bodies_in_the_air(const VoxelMap& before, std::span<const Ray> rays) {
  std::vector<Vec3> bodies;
  if (rays.empty()) return bodies;
  std::vector<HitCell> cells = hit_cells(before, rays);
  const Vec3 sensor = rays[rays.size() / 2].origin.cast<double>();
  int groups = 0;
  for (HitCell& cell : cells) {
    if (!cell.was_surely_free || cell.group != 0) continue;
    if (const auto body = hanging(before, cells, cell, ++groups, sensor)) bodies.push_back(*body);
  }
  if (bodies.size() > kMaxBodies) bodies.clear();
  return bodies;
}

}  // namespace karst::core
