// What the map has to do with a team: the homing tree, landing places, goals that others claimed.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core_stack/homing/home.h"
#include "core_stack/homing/landing_ground.h"
#include "core_stack/mission/explorer.h"
#include "core_stack/planning/grid_planner.h"

namespace karst::core {
namespace {

// Places to make room: so far around, and so far back along the way come.
constexpr double kRefugeReach_m = 12.0, kRetreat_m = 60.0, kRefugeStep_m = 1.0;
constexpr double kGetBy_m = 3.0;
constexpr std::array kGaps_m = {0.5, 0.2};  // beside one that hovers, more than beside rock
constexpr double kAhead_m = 0.3;            // it comes there before the other by so much of the way
constexpr double kElsewhere_m = 2.0, kRefusedNear_m = 0.5;
constexpr std::size_t kEnoughInVain = 2, kMostRefused = 40;

}  // namespace

TreeFacts Explorer::share(const Vec3& here, const TeamNews& news) {
  return homing_->update(map_, wide().roadmap, here, news, std::exchange(closed_, {}));
}

/// Through narrow passages only where there is no other way home: what was passed may look narrower later,
/// and another may have landed in it.
std::optional<LandingSpot> Explorer::nearest_spot(const Vec3& from, double sooner_than_s) {
  if (!homing_) return std::nullopt;
  const auto spot = homing_->spot_from(map_, wide_.roadmap, from, sooner_than_s);
  if (spot || !narrow_ || wide_.way_home.length_m(map_, wide_.roadmap, from)) return spot;
  const Reach& tight = *narrow();
  auto beyond = homing_->spot_from(map_, tight.roadmap, from, sooner_than_s);
  if (!beyond) return std::nullopt;
  beyond->time_s += narrow_length_m(tight.roadmap.find(map_, from, beyond->hover)) / slow_mps();
  return beyond->time_s < sooner_than_s ? beyond : std::nullopt;
}

std::optional<LandingSpot> Explorer::landing_spot(const Vec3& from, double way_come_m) {
  homing_->look_around(map_, wide().roadmap, from);
  return nearest_spot(from, estimate_base(from, way_come_m).time_s);
}

/// It told of its battery, not of its plans: when it must turn home is worked out by one's own map, as for
/// oneself.
OtherVehicle Explorer::seen_by_policy(const HeardMate& mate, TimeNs now) const {
  OtherVehicle out{mate.robot, mate.heard, mate.position, mate.velocity_mps, mate.goal, 0};
  if (!mate.explores) return out;
  constexpr double inf = std::numeric_limits<double>::infinity();
  const double length_m = wide_.way_home.length_m(map_, wide_.roadmap, mate.position).value_or(inf);
  double home_s = home_time_s(length_m, vehicle_.T_world_start.position.z(), home_.z(), options_.motion,
                              options_.mission.landing_speed_mps);
  if (homing_)
    if (const auto spot = homing_->spot_from(map_, wide_.roadmap, mate.position, home_s))
      home_s = spot->time_s;
  const double left_s = mate.seconds_left - seconds(now - mate.heard);
  out.seconds_before_homing =
      std::isfinite(home_s)
          ? home_slack_s(left_s, home_s, options_.mission.home_margin, options_.mission.home_reserve_s)
          : std::numeric_limits<double>::quiet_NaN();
  return out;
}

TreeFacts Explorer::land(const Vec3& hover, TimeNs team_time) {
  return homing_->land(map_, wide().roadmap, hover, team_time);
}

std::optional<Refuge> Explorer::refuge(const Vec3& from, const std::vector<Vec3>& flown, const Vec3& other,
                                       const std::vector<Vec3>& in_vain) {
  const Roadmap& roadmap = wide().roadmap;
  std::vector<Vec3> places{from}, back;
  for (const Vec3& p : roadmap.places_near(from, kRefugeReach_m)) places.push_back(p);
  double back_m = 0;
  for (std::size_t i = flown.size(); i-- > 0 && back_m < kRetreat_m;) {
    if (i + 1 < flown.size()) back_m += (flown[i + 1] - flown[i]).norm();
    if (back.empty() || (back.back() - flown[i]).norm() > kRefugeStep_m) back.push_back(flown[i]);
  }
  places.insert(places.end(), back.begin(), back.end());
  std::vector<double> own_m = roadmap.distances(map_, from, places, map_.resolution_m());
  own_m.front() = 0;
  const std::vector<double> others_m = roadmap.distances(map_, other, places, map_.resolution_m());
  const auto ahead_m = [&](std::size_t i) {
    return (std::isfinite(others_m[i]) ? others_m[i] : (places[i] - other).norm()) - own_m[i];
  };
  const auto near_one_of = [](const std::vector<Vec3>& all, const Vec3& p, double within_m) {
    return std::any_of(all.begin(), all.end(), [&](const Vec3& o) { return (o - p).norm() < within_m; });
  };

  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (std::isfinite(own_m[i]) && ahead_m(i) > kAhead_m && !near_one_of(in_vain, places[i], kElsewhere_m))
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return own_m[a] < own_m[b]; });
  for (const double gap_m : kGaps_m) {
    std::vector<Vec3> refused;
    for (const std::size_t i : order) {
      if (refused.size() == kMostRefused || in_vain.size() >= kEnoughInVain) break;
      if (near_one_of(refused, places[i], kRefusedNear_m) ||
          !is_clear(map_, places[i], options_.planning.clearance_m))
        continue;
      if (others_get_by(map_, places[i], vehicle_.radius_m + gap_m,
                        search_clearance_m(options_.planning, map_.resolution_m()), kGetBy_m))
        return Refuge{places[i], true};
      refused.push_back(places[i]);
    }
  }
  std::optional<std::size_t> farthest;
  for (const std::size_t i : order)
    if (i >= places.size() - back.size() && own_m[i] > kElsewhere_m &&
        (!farthest || own_m[i] > own_m[*farthest]))
      farthest = i;
  return farthest ? std::optional(Refuge{places[*farthest], false}) : std::nullopt;
}

bool Explorer::left_to_others(const Vec3& frontier) const {
  if (!homing_ || claims_waived_) return false;
  const std::vector<Vec3>& goals = homing_->others_goals();
  return std::any_of(goals.begin(), goals.end(),
                     [&](const Vec3& g) { return (g - frontier).norm() < claim_radius_m_; });
}

}  // namespace karst::core
