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
constexpr double kLead_m = 1.0;             // more than two vehicles are wide
constexpr double kNearShare = 0.4;          // of the present distance to another, where that is short
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

/// By how much the vehicle must arrive before another: see waiting_place.h.
double lead_m(const RoomQuery& query, const Neighbour& other) {
  return std::min(kLead_m, kNearShare * (other.position - query.from).norm());
}

/// The path length to each place within which the vehicle arrives there before every other one. Others fly
/// along the straight line where the map has no path.
std::vector<double> at_most_m(const VoxelMap& map, const Roadmap& roadmap, const RoomQuery& query,
                              const std::vector<Vec3>& places) {
  std::vector<double> at_most(places.size(), std::numeric_limits<double>::infinity());
  for (const Neighbour& o : query.others) {
    if (o.phase == TeamPhase::aside || (o.position - query.from).norm() > kRetreat_m) continue;
    const std::vector<double> path_m = roadmap.distances(map, o.position, places, map.resolution_m());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double other_m = std::isfinite(path_m[i]) ? path_m[i] : (places[i] - o.position).norm();
      at_most[i] = std::min(at_most[i], other_m - lead_m(query, o));
    }
  }
  return at_most;
}

/// Whether the place is too near to another vehicle, and nearer than this one is now.
bool crowds(const RoomQuery& query, const Vec3& place) {
  return std::any_of(query.others.begin(), query.others.end(), [&](const Neighbour& o) {
    return (o.position - place).norm() < std::min(query.separation_m, (o.position - query.from).norm());
  });
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
  const std::vector<double> at_most = at_most_m(map, roadmap, query, places);

  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (std::isfinite(own_m[i]) && own_m[i] < at_most[i] && !crowds(query, places[i]) &&
        !near_one_of(query.failed, places[i], kElsewhere_m))
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return own_m[a] < own_m[b]; });
  const PlanningOptions& planning = roadmap.options();
  for (const double gap_m : kGaps_m) {
    if (query.failed.size() >= kMaxFailed) break;
    std::vector<Vec3> refused;
    for (const std::size_t i : order) {
      if (refused.size() == kMaxRefused) break;
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
