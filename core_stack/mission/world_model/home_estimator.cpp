#include "core_stack/mission/world_model/home_estimator.h"

#include <cmath>
#include <limits>

#include "core_stack/mission/flight/trusted_speeds.h"

namespace karst::core {

HomeEstimator::HomeEstimator(const CoreOptions& options, const VehicleDescription& vehicle, WorldModel& world,
                             const TeamMembership& team)
    : motion_(options.motion),
      home_margin_(options.mission.home_margin),
      home_reserve_s_(options.mission.home_reserve_s),
      landing_speed_mps_(options.mission.landing_speed_mps),
      slow_speed_mps_(core::slow_speed_mps(options)),
      ground_z_m_(vehicle.T_world_start.position.z()),
      world_(&world),
      team_(&team) {}

HomeEstimate HomeEstimator::estimate(const Vec3& from, double flown_m) {
  const HomeEstimate start = to_start(from, flown_m);
  const std::optional<LandingSpot> spot = nearest_spot(from, start.time_s);
  return spot ? HomeEstimate{spot->length_m, spot->time_s} : start;
}

std::optional<LandingSpot> HomeEstimator::landing_spot(const Vec3& from, double flown_m) {
  team_->homing()->look_around(world_->map(), world_->usual().roadmap(), from);
  return nearest_spot(from, to_start(from, flown_m).time_s);
}

double HomeEstimator::slack_s(double seconds_left, const HomeEstimate& home) const {
  return home_slack_s(seconds_left, home.time_s, home_margin_, home_reserve_s_);
}

double HomeEstimator::time_home_s(double length_m) const {
  return home_time_s(length_m, ground_z_m_, world_->home().z(), motion_, landing_speed_mps_);
}

/// The extra time for narrow passages, where flight is slow.
double HomeEstimator::extra_time_s(const Path& path) const {
  return world_->narrow_length_m(path) / slow_speed_mps_;
}

HomeEstimate HomeEstimator::to_start(const Vec3& from, double flown_m) {
  const VoxelMap& map = world_->map();
  if (const auto length_m = world_->usual().home_length_m(map, from))
    return {*length_m, time_home_s(*length_m)};
  if (const ClearanceRoadmap* const narrow = world_->narrow_if_made())
    if (const auto length_m = narrow->home_length_m(map, from))
      return {*length_m, extra_time_s(narrow->path_home(map, from)) + time_home_s(*length_m)};
  return {flown_m, time_home_s(flown_m), false};
}

/// Uses narrow passages only if there is no other path home: a passage that was flown may look narrower
/// later, and another vehicle may have landed in it.
std::optional<LandingSpot> HomeEstimator::nearest_spot(const Vec3& from, double sooner_than_s) {
  const RelayHoming* const homing = team_->homing();
  if (!homing) return std::nullopt;
  const VoxelMap& map = world_->map();
  const ClearanceRoadmap& usual = world_->usual();
  const auto spot = homing->spot_from(map, usual.roadmap(), from, sooner_than_s);
  if (spot || usual.home_length_m(map, from)) return spot;
  const ClearanceRoadmap* const narrow = world_->narrow_if_made();
  if (!narrow) return std::nullopt;
  auto beyond = homing->spot_from(map, narrow->roadmap(), from, sooner_than_s);
  if (!beyond) return std::nullopt;
  beyond->time_s += extra_time_s(narrow->roadmap().find(map, from, beyond->hover));
  return beyond->time_s < sooner_than_s ? beyond : std::nullopt;
}

OtherVehicle HomeEstimator::seen_by_policy(const TeammateState& teammate, TimeNs now) {
  OtherVehicle out{teammate.robot,        teammate.heard, teammate.position,
                   teammate.velocity_mps, teammate.goal,  0};
  if (!teammate.explores) return out;
  const VoxelMap& map = world_->map();
  const ClearanceRoadmap& usual = world_->usual();
  constexpr double inf = std::numeric_limits<double>::infinity();
  HomeEstimate home;
  home.length_m = usual.home_length_m(map, teammate.position).value_or(inf);
  home.time_s = time_home_s(home.length_m);
  if (const RelayHoming* const homing = team_->homing())
    if (const auto spot = homing->spot_from(map, usual.roadmap(), teammate.position, home.time_s))
      home.time_s = spot->time_s;
  const double left_s = teammate.seconds_left - seconds(now - teammate.heard);
  out.seconds_before_homing =
      std::isfinite(home.time_s) ? slack_s(left_s, home) : std::numeric_limits<double>::quiet_NaN();
  return out;
}

}  // namespace karst::core
