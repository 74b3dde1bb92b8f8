#include "core_stack/planning/free_space/escape.h"

#include <algorithm>
#include <map>
#include <set>

#include "core_stack/mapping/region/flight_region.h"

namespace karst::core {

std::optional<std::vector<Vec3>> escape_path(const VoxelMap& map, FreeTiles& free, const Vec3& start,
                                             double clearance_m) {
  struct Visit {
    double length_m, distance_m;  // of the path so far; to the nearest obstacle
    CellKey parent;
  };
  const double res = free.resolution_m(), radius_m = 2 * clearance_m + 2 * res;
  free.load_near(map, start, radius_m + clearance_m);
  const CellKey first = free.key_of(start);
  if (!free.at(first))
    return map.at(first) == Cell::free ? path_back_inside(map, free, start, clearance_m) : std::nullopt;

  std::map<CellKey, Visit> visits{{first, {0, free.nearest(start, clearance_m).distance_m, first}}};
  std::set<std::pair<double, CellKey>> open{{0.0, first}};
  while (!open.empty()) {
    const CellKey k = open.begin()->second;
    open.erase(open.begin());
    const Visit at = visits.at(k);
    const Vec3 p = k == first ? start : free.center_of(k);
    if (!(k == first) && free.is_clear(p, clearance_m)) {
      std::vector<Vec3> out;
      for (CellKey c = k; !(c == first); c = visits.at(c).parent) out.push_back(free.center_of(c));
      out.push_back(start);
      std::reverse(out.begin(), out.end());
      return out;
    }
    for (int i = 0; i < 27; ++i) {
      const CellKey n = k + CellKey{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
      const Vec3 q = free.center_of(n);
      if (n == first || (q - start).norm() > radius_m || !free.at(n)) continue;
      const double distance = free.nearest(q, clearance_m).distance_m;
      const double length = at.length_m + (q - p).norm();
      const auto known = visits.find(n);
      // Between two cells the distance may fall by a fraction of a cell below the distance at either.
      if (distance < at.distance_m || (known != visits.end() && known->second.length_m <= length) ||
          !free.segment_clear(p, q, std::max(0.0, at.distance_m - 0.25 * res)))
        continue;
      if (known != visits.end()) open.erase({known->second.length_m, n});
      visits[n] = {length, distance, k};
      open.insert({length, n});
    }
  }
  return std::nullopt;
}

std::optional<std::vector<Vec3>> path_back_inside(const VoxelMap& map, FreeTiles& free, const Vec3& start,
                                                  double clearance_m, std::size_t max_cells) {
  constexpr double kLongest_m = 15, kWeight = 1.2;
  struct Visit {
    double length_m;
    CellKey parent;
  };
  FreeTiles anywhere(free.resolution_m(), Confined::no);
  const auto load = [&](const Vec3& p) {
    free.load_near(map, p, 2 * clearance_m);
    anywhere.load_near(map, p, 2 * clearance_m);
  };
  load(start);
  const CellKey first = free.key_of(start);
  if (!anywhere.at(first)) return std::nullopt;
  // Between two cells the distance may fall by a fraction of a cell below the distance at either.
  const double kept_m = std::min(clearance_m, std::max(0.0, anywhere.nearest(start, clearance_m).distance_m -
                                                                0.25 * free.resolution_m()));

  // Weighted A*: the depth grows by no more than the distance moved, so what is missing is a consistent lower
  // bound. A clear cell lies deeper; without the weight that difference would widen the search to a ball.
  const FlightRegion* region = map.region();
  const auto missing_m = [region](const Vec3& p) {
    return region ? std::max(0.0, region->limits().margin_m - region->depth_m(p)) : 0.0;
  };
  std::map<CellKey, Visit> visits{{first, {0, first}}};
  std::set<std::pair<double, CellKey>> open{{kWeight * missing_m(start), first}};
  for (std::size_t cells = 0; !open.empty() && cells < max_cells; ++cells) {
    const CellKey k = open.begin()->second;
    const double length_m = visits.at(k).length_m;
    open.erase(open.begin());
    const Vec3 p = k == first ? start : free.center_of(k);
    load(p);
    if (!(k == first) && free.is_clear(p, clearance_m)) {
      std::vector<Vec3> out;
      for (CellKey c = k; !(c == first); c = visits.at(c).parent) out.push_back(free.center_of(c));
      out.push_back(start);
      std::reverse(out.begin(), out.end());
      return out;
    }
    for (int i = 0; i < 27; ++i) {
      const CellKey n = k + CellKey{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
      const Vec3 q = free.center_of(n);
      const double further_m = length_m + (q - p).norm();
      const auto known = visits.find(n);
      const double rest_m = missing_m(q);
      if (n == first || further_m + rest_m > kLongest_m ||
          (known != visits.end() && known->second.length_m <= further_m) ||
          !anywhere.segment_clear(p, q, kept_m))
        continue;
      if (known != visits.end()) open.erase({known->second.length_m + kWeight * rest_m, n});
      visits[n] = {further_m, k};
      open.insert({further_m + kWeight * rest_m, n});
    }
  }
  return std::nullopt;
}

}  // namespace karst::core
