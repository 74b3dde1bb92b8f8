#include "sdk/evaluation/reachable/reachable_in_region.h"

#include <cmath>
#include <queue>
#include <unordered_map>
#include <vector>

#include "core_stack/common/decimal_text.h"
#include "core_stack/common/error.h"
#include "sdk/evaluation/reachable/sight.h"

namespace karst::evaluation {
namespace {

using core::Vec3;

constexpr double kStartSearch_m = 3;

/// The cells of `set` that `keep` says to; the blocks stay the same.
template <class Keep>
CellSet kept(const CellSet& set, const Keep& keep) {
  CellSet out = set;
  set.for_each([&](const CellKey& k) {
    if (!keep(k)) (*out.find(out.block_of(k)))[k.z & 7] &= ~(std::uint64_t{1} << ((k.y & 7) * 8 + (k.x & 7)));
  });
  return out;
}

std::optional<CellKey> nearest_cell(const CellSet& set, const Vec3& p, double edge_m) {
  std::optional<CellKey> nearest;
  double least_m = kStartSearch_m;
  set.for_each([&](const CellKey& k) {
    if (const double away_m = (center_of(k, edge_m) - p).norm(); away_m < least_m) {
      least_m = away_m;
      nearest = k;
    }
  });
  return nearest;
}

/// The cells of `set` no farther from `first` than `most_m`, by Dijkstra's search.
CellSet within_path(const CellSet& set, const CellKey& first, double most_m, double edge_m) {
  std::unordered_map<CellKey, double, core::CellKeyHash> length_m{{first, 0}};
  using Entry = std::pair<double, CellKey>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.emplace(0, first);
  while (!open.empty()) {
    const auto [at_m, k] = open.top();
    open.pop();
    if (at_m > length_m.at(k)) continue;
    for (int i = 0; i < 27; ++i) {
      const CellKey step{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
      const CellKey n = k + step;
      const double further_m =
          at_m + edge_m * std::sqrt(static_cast<double>(step.x * step.x + step.y * step.y + step.z * step.z));
      if (further_m > most_m || !set.contains(n)) continue;
      const auto known = length_m.find(n);
      if (known != length_m.end() && known->second <= further_m) continue;
      length_m[n] = further_m;
      open.emplace(further_m, n);
    }
  }
  return kept(set, [&](const CellKey& k) { return length_m.contains(k); });
}

}  // namespace

Reachable reachable_in_region(const Reachable& all, const core::FlightRegion& region, const Vec3& start,
                              const std::string& name) {
  const double edge_m = all.options.resolution_m;
  const core::FlightRegion::Limits& limits = region.limits();
  Reachable r;
  r.options = all.options;
  r.free = all.free;
  r.free_cells = all.free_cells;
  r.flyable = kept(all.flyable, [&](const CellKey& k) {
    return region.depth_m(center_of(k, edge_m)) >= limits.margin_m + all.options.clearance_m;
  });
  const std::optional<CellKey> first = nearest_cell(r.flyable, start, edge_m);
  if (!first)
    throw core::InputError(name, "start " + core::decimal_text(start, 1),
                           "the region leaves no place to fly near it");
  r.flyable = flood(r.flyable, *first);
  if (limits.max_home_m) r.flyable = within_path(r.flyable, *first, *limits.max_home_m, edge_m);
  r.flyable_cells = r.flyable.size();
  r.reachable = kept(seen_from(r.flyable, r.free, all.options.sight_m / edge_m),
                     [&](const CellKey& k) { return region.contains(center_of(k, edge_m)); });
  r.reachable_cells = r.reachable.size();
  return r;
}

}  // namespace karst::evaluation
