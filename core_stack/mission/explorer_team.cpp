// What the map has to do with a team: the homing tree, landing places, goals that others claimed.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core_stack/homing/home.h"
#include "core_stack/mission/explorer.h"

namespace karst::core {
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

std::optional<Refuge> Explorer::refuge(RoomQuery query) {
  query.vehicle_radius_m = vehicle_.radius_m;
  return waiting_place(map_, wide().roadmap, query);
}

bool Explorer::left_to_others(const Vec3& frontier) const {
  if (!homing_ || claims_waived_) return false;
  const std::vector<Vec3>& goals = homing_->others_goals();
  return std::any_of(goals.begin(), goals.end(),
                     [&](const Vec3& g) { return (g - frontier).norm() < claim_radius_m_; });
}

}  // namespace karst::core
