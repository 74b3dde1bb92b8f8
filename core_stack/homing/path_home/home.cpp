#include "core_stack/homing/path_home/home.h"

#include <algorithm>
#include <cmath>

namespace karst::core {
namespace {

/// Ratio of the mean speed along the roadmap's path to the maximal speed. That path zigzags and is a few per
/// cent longer than the path flown; bends and turns cost time. Flights home of 35 to 250 m reached 0.88 to
/// 0.98 of the maximal speed.
constexpr double kCruiseFraction = 0.8;
/// Bends keep a fast vehicle slow: ways home of 45 to 142 m in two large caves were flown at 2.3 to 2.6 m/s
/// with 2 m/s^2 and at 2.9 to 3.7 m/s with 4 m/s^2, whether 4 or 6 m/s were allowed; one of 143 m through a
/// winding passage 2.6 m wide, where sight is short, at 2.4 m/s with 4 m/s^2. A bend of this radius takes all
/// of the acceleration, and 2 m/s are always reached.
constexpr double kBend_m = 2.2, kAlways_mps = 2.0;

/// Flying straight away from home at maximal speed uses less than 3 s of slack a second.
constexpr double kAtOnce_s = 5.0;
constexpr int kDoubtedTimes = 3;

}  // namespace

void PathHome::update(const VoxelMap& map, const Roadmap& roadmap, const Vec3& home,
                      const PlanningOptions& options) {
  const std::optional<Vec3> place = roadmap.approach(map, home, 2 * options.preferred_clearance_m);
  known_ = place.has_value();
  if (!known_) return;
  rest_m_ = (*place - home).norm();
  tree_.update(roadmap, *place);
}

std::optional<double> PathHome::length_m(const VoxelMap& map, const Roadmap& roadmap,
                                         const Vec3& from) const {
  if (!known_) return std::nullopt;
  const std::optional<double> length_m = tree_.length_m(map, roadmap, from);
  if (!length_m) return std::nullopt;
  return *length_m + rest_m_;
}

Path PathHome::find(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from) const {
  if (known_) return tree_.find(map, roadmap, from);
  Path none;
  none.reason = "home cannot be approached";
  return none;
}

double cruise_speed_mps(const MotionLimits& limits) {
  const double in_bends_mps = std::max(kAlways_mps, std::sqrt(kBend_m * limits.max_acceleration_mps2));
  return kCruiseFraction * std::min(limits.max_speed_mps, in_bends_mps);
}

double flight_time_s(double length_m, const MotionLimits& limits) {
  const double cruise = cruise_speed_mps(limits), a = limits.max_acceleration_mps2;
  // Acceleration and braking take cruise / a each; short paths never reach cruise speed.
  return length_m >= cruise * cruise / a ? length_m / cruise + cruise / a : 2 * std::sqrt(length_m / a);
}

double home_time_s(double length_m, double ground_z_m, double home_z_m, const MotionLimits& limits,
                   double landing_speed_mps) {
  return flight_time_s(length_m, limits) + std::max(0.0, home_z_m - ground_z_m) / landing_speed_mps;
}

double home_slack_s(double seconds_left, double home_time, double margin, double reserve_s) {
  return seconds_left - home_time * (1 + margin) - reserve_s;
}

bool ReturnTrigger::due(double slack_s) {
  if (slack_s > 0) {
    before_s_ = slack_s;
    doubted_ = 0;
    return false;
  }
  return before_s_ - slack_s <= kAtOnce_s || ++doubted_ > kDoubtedTimes;
}

}  // namespace karst::core
