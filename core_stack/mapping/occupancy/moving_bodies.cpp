#include "core_stack/mapping/occupancy/moving_bodies.h"

#include <algorithm>
#include <optional>

namespace karst::core {
namespace {

constexpr double kMaxAcross_m = 1.0;  // of the returns from a vehicle
// With the cells that it has left occupied behind it while it was not known to move.
constexpr double kMaxTrail_m = 2.0;
constexpr std::size_t kFewestReturns = 5;
// Log-odds: passed by three scans, and by six. Nearer to rock than a cell noise keeps them from the latter.
constexpr float kFree = -0.5f, kSurelyFree = -1.1f;

/// A cell that the scan hits and that is not rock.
struct HitCell {
  CellKey key;
  Vec3 sum = Vec3::Zero();  // of the returns in it
  std::size_t returns = 0;
  bool was_free = false, was_surely_free = false;
  int group = -1;      // that it belongs to together with what is occupied
  bool taken = false;  // into a body, or into what turned out to be none
};

HitCell* find(std::vector<HitCell>& cells, const CellKey& key) {
  const auto at = std::lower_bound(cells.begin(), cells.end(), key,
                                   [](const HitCell& c, const CellKey& k) { return c.key < k; });
  return at != cells.end() && at->key == key ? &*at : nullptr;
}

std::vector<HitCell> hit_cells(const VoxelMap& map, std::span<const Ray> rays) {
  std::vector<std::pair<CellKey, Vec3f>> ends;
  for (const Ray& ray : rays) {
    if (!ray.hit || !ray.end.allFinite()) continue;
    const CellKey key = map.key_of(ray.end.cast<double>());
    if (map.at(key) != Cell::occupied) ends.emplace_back(key, ray.end);
  }
  std::stable_sort(ends.begin(), ends.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<HitCell> cells;
  for (const auto& [key, end] : ends) {
    if (cells.empty() || cells.back().key != key) {
      cells.push_back({.key = key});
      const float before = map.log_odds(key).value_or(0);
      cells.back().was_free = before < kFree;
      cells.back().was_surely_free = before < kSurelyFree;
    }
    cells.back().sum += end.cast<double>();
    ++cells.back().returns;
  }
  return cells;
}

template <class Visit>
void for_each_neighbour(const CellKey& center, const Visit& visit) {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) visit(center + CellKey{x, y, z});
}

/// Cells that touch one another.
struct Group {
  int number;
  Vec3 sum = Vec3::Zero();
  std::size_t returns = 0;
  CellKey low{}, high{}, hit_low{}, hit_high{};
  std::vector<CellKey> members{};

  Group(int number_, HitCell& first)
      : number(number_), low(first.key), high(first.key), hit_low(first.key), hit_high(first.key) {
    take(first);
  }
  void take(HitCell& cell) {
    cell.group = number;
    cell.taken = true;
    sum += cell.sum;
    returns += cell.returns;
    widen(hit_low, hit_high, cell.key);
    take(cell.key);
  }
  void take(const CellKey& occupied) {
    widen(low, high, occupied);
    members.push_back(occupied);
  }
  static void widen(CellKey& low, CellKey& high, const CellKey& k) {
    low = {std::min(low.x, k.x), std::min(low.y, k.y), std::min(low.z, k.z)};
    high = {std::max(high.x, k.x), std::max(high.y, k.y), std::max(high.z, k.z)};
  }
  static double across_m(const CellKey& low, const CellKey& high, double resolution_m) {
    return resolution_m * std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  }
  bool is_body(double resolution_m) const {
    return returns >= kFewestReturns && across_m(hit_low, hit_high, resolution_m) < kMaxAcross_m;
  }
  Vec3 middle() const { return sum / static_cast<double>(returns); }
};

/// What touches `first`, hit or occupied, if that is nothing large: a body that hangs in the air.
std::optional<Vec3> hanging(const VoxelMap& map, std::vector<HitCell>& cells, HitCell& first, int number) {
  Group group(number, first);
  std::vector<CellKey> occupied;
  bool large = false;
  for (std::size_t i = 0; i < group.members.size() && !large; ++i) {
    for_each_neighbour(CellKey(group.members[i]), [&](const CellKey& key) {
      if (HitCell* hit = find(cells, key)) {
        if (hit->group == number) return;
        large = large || hit->group >= 0;  // of one that was too large
        group.take(*hit);
      } else if (map.at(key) == Cell::occupied) {
        const auto known = std::lower_bound(occupied.begin(), occupied.end(), key);
        if (known != occupied.end() && *known == key) return;
        occupied.insert(known, key);
        group.take(key);
      }
    });
    large = large || Group::across_m(group.low, group.high, map.resolution_m()) > kMaxTrail_m;
  }
  return !large && group.is_body(map.resolution_m()) ? std::optional(group.middle()) : std::nullopt;
}

/// What touches `first` of the cells that surely were free: of a body that passes close by rock what stands
/// out from it.
std::optional<Vec3> standing_out(const VoxelMap& map, std::vector<HitCell>& cells, HitCell& first) {
  Group group(first.group, first);
  for (std::size_t i = 0; i < group.members.size(); ++i)
    for_each_neighbour(CellKey(group.members[i]), [&](const CellKey& key) {
      HitCell* hit = find(cells, key);
      if (hit && hit->was_surely_free && !hit->taken) group.take(*hit);
    });
  return group.is_body(map.resolution_m()) ? std::optional(group.middle()) : std::nullopt;
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
  std::vector<HitCell> cells = hit_cells(before, rays);
  std::vector<Vec3> bodies;
  std::vector<bool> hangs;  // by group
  for (HitCell& cell : cells) {
    if (!cell.was_free || cell.group >= 0) continue;
    const auto body = hanging(before, cells, cell, static_cast<int>(hangs.size()));
    hangs.push_back(body.has_value());
    if (body) bodies.push_back(*body);
  }
  for (HitCell& cell : cells) cell.taken = cell.group >= 0 && hangs[static_cast<std::size_t>(cell.group)];
  for (HitCell& cell : cells)
    if (cell.was_surely_free && !cell.taken)
      if (const auto body = standing_out(before, cells, cell)) bodies.push_back(*body);
  return bodies;
}

}  // namespace karst::core
