#include "core_stack/homing/home.h"

#include <algorithm>
#include <cmath>

namespace karst::core {
namespace {

/// Mean speed on the roadmap's way over the greatest speed. The way zigzags some per cent longer than what is
/// flown, and bends and turning cost time. Flights home of 35 to 250 m took 0.88 to 0.98 of the greatest speed.
constexpr double kCruiseShare = 0.8;

}  // namespace

HomePlan plan_home(const VoxelMap& map, const Roadmap& roadmap, const Vec3& position, const Vec3& home,
                   const PlanningOptions& options) {
  HomePlan out;
  const std::optional<Vec3> place = roadmap.approach(map, home, 2 * options.preferred_clearance_m);
  if (!place) {
    out.reason = "no clear place is known near home";
    return out;
  }
  Path path = roadmap.find(map, position, *place);
  out.found = path.found();
  out.reason = path.reason;
  if (!out.found) return out;
  if ((*place - home).norm() > 1e-9) path.points.push_back(home);
  out.points = std::move(path.points);
  out.length_m = path_length_m(out.points);
  return out;
}

double home_time_s(double length_m, double ground_z_m, double home_z_m, const MotionLimits& limits,
                   double landing_speed_mps) {
  const double cruise = kCruiseShare * limits.max_speed_mps, a = limits.max_acceleration_mps2;
  // From rest to rest: a ramp up and a ramp down of cruise / a each, shorter ways never reach the cruise.
  const double fly_s =
      length_m >= cruise * cruise / a ? length_m / cruise + cruise / a : 2 * std::sqrt(length_m / a);
  return fly_s + std::max(0.0, home_z_m - ground_z_m) / landing_speed_mps;
}

double home_slack_s(double battery_seconds_left, double home_time, double margin, double reserve_s) {
  return battery_seconds_left - home_time * (1 + margin) - reserve_s;
}

}  // namespace karst::core
