#include "core_stack/mission/flight/emergency_landing.h"

#include <algorithm>
#include <cmath>

namespace karst::core {
namespace {

constexpr TimeNs kPeriod = 50 * kMillisecond;
/// No later motion depends on its timing, so the brake may use nearly the full acceleration.
constexpr double kFraction = 0.95;
/// Pause between braking and descent: the vehicle lags a little behind its reference.
constexpr TimeNs kStandStill = 500 * kMillisecond;
constexpr double kDeepest_m = 1000;
/// A path that begins farther from the stop is out of date.
constexpr double kStale_m = 2;
constexpr double kMove_mps = 1.0;  // maximal speed, from rest to rest
constexpr std::size_t kMoveSamples = 256;

}  // namespace

EmergencyLanding::EmergencyLanding(const MotionLimits& limits, double descent_mps)
    : deceleration_mps2_(kFraction * limits.max_acceleration_mps2),
      max_samples_(2 + static_cast<std::size_t>(
                           std::ceil(limits.max_speed_mps / (deceleration_mps2_ * seconds(kPeriod))))) {
  brake_.period = kPeriod;
  brake_.samples.reserve(max_samples_);
  move_.samples.resize(kMoveSamples);
  descent_.period = from_seconds(kDeepest_m / descent_mps);
  descent_.samples.resize(2);
}

void EmergencyLanding::prepare(std::span<const Vec3> path) noexcept {
  if (begun_) return;
  places_ = path.size() <= kMaxPlaces ? path.size() : 0;
  std::copy_n(path.begin(), places_, path_.begin());
}

/// Brakes by slowing time along the trajectory x: after t of the braking time T = v / a the reference is at
/// x(t - t^2 / (2 T)). The vehicle thus stays on its path, which is known to be free, and decelerates from v
/// to rest at the rate a.
void EmergencyLanding::begin(const Trajectory& under_way, TimeNs now, double max_path_m) noexcept {
  if (begun_) return;
  begun_ = true;
  const double speed_mps =
      (under_way.at(now + kPeriod).position - under_way.at(now).position).norm() / seconds(kPeriod);
  const double wanted = std::ceil(speed_mps / (deceleration_mps2_ * seconds(kPeriod)));
  const double needed = std::isfinite(wanted) ? wanted : 0;
  const auto steps = static_cast<std::size_t>(std::clamp(needed, 0.0, static_cast<double>(max_samples_ - 1)));
  const double end_s = static_cast<double>(steps) * seconds(kPeriod);
  brake_.start = now;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) * seconds(kPeriod);
    const double flown_s = steps > 0 ? t - t * t / (2 * end_s) : 0;
    brake_.samples.push_back(under_way.at(now + from_seconds(flown_s)));
  }
  plan_move(brake_.end() + kStandStill, max_path_m);
  descent_.start = move_.period > 0 ? move_.end() + kStandStill : move_.start;
  descent_.samples[0] = descent_.samples[1] = move_.samples.back();
  descent_.samples[1].position.z() -= kDeepest_m;
}

/// Moves along the path from rest to rest: after the fraction u of the time 1.5 L / v, the fraction 3 u^2 - 2
/// u^3 of the length L, so that the speed never exceeds v. Without a path the vehicle stays where it stopped.
void EmergencyLanding::plan_move(TimeNs start, double max_path_m) noexcept {
  const TrajectorySample stop = brake_.samples.back();
  move_.start = start;
  move_.period = 0;
  std::fill(move_.samples.begin(), move_.samples.end(), stop);
  if (places_ < 2 || (path_[0] - stop.position).norm() > kStale_m) return;
  path_[0] = stop.position;
  double length_m = 0;
  for (std::size_t i = 1; i < places_; ++i) length_m += (path_[i] - path_[i - 1]).norm();
  if (length_m > max_path_m) return;
  move_.period = from_seconds(1.5 * length_m / kMove_mps / static_cast<double>(kMoveSamples - 1));
  std::size_t leg = 1;
  double before_m = 0;  // length of the legs already passed
  for (std::size_t k = 0; k < kMoveSamples; ++k) {
    const double u = static_cast<double>(k) / static_cast<double>(kMoveSamples - 1);
    const double path_m = length_m * u * u * (3 - 2 * u);
    double leg_m = (path_[leg] - path_[leg - 1]).norm();
    while (leg + 1 < places_ && before_m + leg_m < path_m) {
      before_m += leg_m;
      ++leg;
      leg_m = (path_[leg] - path_[leg - 1]).norm();
    }
    const double fraction = leg_m > 0 ? std::min(1.0, (path_m - before_m) / leg_m) : 1;
    move_.samples[k].position = path_[leg - 1] + fraction * (path_[leg] - path_[leg - 1]);
  }
}

void EmergencyLanding::break_off() {
  begun_ = false;
  places_ = 0;
  brake_.samples.clear();
}

const Trajectory& EmergencyLanding::trajectory(TimeNs now) const {
  if (now < move_.start) return brake_;
  return now < descent_.start ? move_ : descent_;
}

}  // namespace karst::core
