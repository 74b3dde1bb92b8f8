#include "core_stack/team/right_of_way/waiting_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core_stack/homing/landing/landing_ground.h"
#include "core_stack/planning/search/grid_planner.h"

namespace karst::core {
namespace {

// The search radius, and the length of the flown path searched.
constexpr double kSearchRadius_m = 12.0, kRetreat_m = 60.0, kStep_m = 1.0;
constexpr double kGetBy_m = 3.0;
constexpr std::array kGaps_m = {0.5, 0.2};  // beside a hovering vehicle, more than beside rock
constexpr double kAhead_m = 0.3;            // path length by which it must arrive before the others
constexpr double kElsewhere_m = 2.0, kRefusedNear_m = 0.5;
constexpr std::size_t kMaxFailed = 2, kMaxRefused = 40;

bool near_one_of(const std::vector<Vec3>& all, const Vec3& p, double within_m) {
  return std::any_of(all.begin(), all.end(), [&](const Vec3& o) { return (o - p).norm() < within_m; });
}

std::vector<Vec3> points_back(const std::vector<Vec3>& flown) {
  std::vector<Vec3> back;
  double length_m = 0;
  for (std::size_t i = flown.size(); i-- > 0 && length_m < kRetreat_m;) {
    if (i + 1 < flown.size()) length_m += (flown[i + 1] - flown[i]).norm();
    if (back.empty() || (back.back() - flown[i]).norm() > kStep_m) back.push_back(flown[i]);
  }
  return back;
}

/// The distance to each place for the first of all others to arrive; along the straight line where the map
/// has no path.
std::vector<double> first_of_others_m(const VoxelMap& map, const Roadmap& roadmap, const RoomQuery& query,
                                      const std::vector<Vec3>& places) {
  std::vector<double> first(places.size(), std::numeric_limits<double>::infinity());
  std::vector<Vec3> others{query.other};
  for (const Vec3& o : query.moving)
    if ((o - query.from).norm() < kRetreat_m) others.push_back(o);
  for (const Vec3& o : others) {
    const std::vector<double> path_m = roadmap.distances(map, o, places, map.resolution_m());
    for (std::size_t i = 0; i < places.size(); ++i)
      first[i] = std::min(first[i], std::isfinite(path_m[i]) ? path_m[i] : (places[i] - o).norm());
  }
  return first;
}

/// Whether the place is too near to another vehicle, and nearer than this one is now.
bool crowds(const RoomQuery& query, const Vec3& place) {
  const auto by = [&](const Vec3& o) {
    return (o - place).norm() < std::min(query.separation_m, (o - query.from).norm());
  };
  return by(query.other) || std::any_of(query.moving.begin(), query.moving.end(), by) ||
         std::any_of(query.standing.begin(), query.standing.end(), by);
}

}  // namespace

std::optional<WaitingPlace> waiting_place(const VoxelMap& map, const Roadmap& roadmap,
                                          const RoomQuery& query) {
  const std::vector<Vec3> back = points_back(query.flown);
  std::vector<Vec3> places{query.from};
  for (const Vec3& p : roadmap.places_near(query.from, kSearchRadius_m)) places.push_back(p);
  places.insert(places.end(), back.begin(), back.end());
  std::vector<double> own_m = roadmap.distances(map, query.from, places, map.resolution_m());
  own_m.front() = 0;
  const std::vector<double> others_m = first_of_others_m(map, roadmap, query, places);

  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (std::isfinite(own_m[i]) && others_m[i] - own_m[i] > kAhead_m && !crowds(query, places[i]) &&
        !near_one_of(query.failed, places[i], kElsewhere_m))
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return own_m[a] < own_m[b]; });
  const PlanningOptions& planning = roadmap.options();
  for (const double gap_m : kGaps_m) {
    std::vector<Vec3> refused;
    for (const std::size_t i : order) {
      if (refused.size() == kMaxRefused || query.failed.size() >= kMaxFailed) break;
      if (near_one_of(refused, places[i], kRefusedNear_m) || !is_clear(map, places[i], planning.clearance_m))
        continue;
      if (keeps_passage_open(map, places[i], query.vehicle_radius_m + gap_m,
                             search_clearance_m(planning, map.resolution_m()), kGetBy_m))
        return WaitingPlace{places[i], true};
      refused.push_back(places[i]);
    }
  }
  std::optional<std::size_t> farthest;
  for (const std::size_t i : order)
    if (i >= places.size() - back.size() && own_m[i] > kElsewhere_m &&
        (!farthest || own_m[i] > own_m[*farthest]))
      farthest = i;
  return farthest ? std::optional(WaitingPlace{places[*farthest], false}) : std::nullopt;
}

}  // namespace karst::core
