#include "core_stack/mission/emergency_landing.h"

#include <algorithm>
#include <cmath>

namespace karst::core {
namespace {

constexpr TimeNs kPeriod = 50 * kMillisecond;
/// Nothing follows that could be missed for a delay: it may use nearly all the acceleration there is.
constexpr double kShare = 0.95;
/// Between brake and descent: the vehicle itself is a little behind its reference.
constexpr TimeNs kStandStill = 500 * kMillisecond;
constexpr double kDeepest_m = 1000;

}  // namespace

EmergencyLanding::EmergencyLanding(const MotionLimits& limits, double descent_mps)
    : deceleration_mps2_(kShare * limits.max_acceleration_mps2),
      most_samples_(2 + static_cast<std::size_t>(
                            std::ceil(limits.max_speed_mps / (deceleration_mps2_ * seconds(kPeriod))))) {
  brake_.period = kPeriod;
  brake_.samples.reserve(most_samples_);
  descent_.period = from_seconds(kDeepest_m / descent_mps);
  descent_.samples.resize(2);
}

/// The trajectory x is flown on ever more slowly: after t of the T = v / a that the brake takes, as far as it
/// would have come in t - t^2 / (2 T). So it stays on its path, which is known to be free, and from the speed
/// v comes to rest with the deceleration a.
void EmergencyLanding::begin(const Trajectory& under_way, TimeNs now) noexcept {
  if (begun_) return;
  begun_ = true;
  const double speed_mps =
      (under_way.at(now + kPeriod).position - under_way.at(now).position).norm() / seconds(kPeriod);
  const double wanted = std::ceil(speed_mps / (deceleration_mps2_ * seconds(kPeriod)));
  const double needed = std::isfinite(wanted) ? wanted : 0;
  const auto steps =
      static_cast<std::size_t>(std::clamp(needed, 0.0, static_cast<double>(most_samples_ - 1)));
  const double end_s = static_cast<double>(steps) * seconds(kPeriod);
  brake_.start = now;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) * seconds(kPeriod);
    const double flown_s = steps > 0 ? t - t * t / (2 * end_s) : 0;
    brake_.samples.push_back(under_way.at(now + from_seconds(flown_s)));
  }
  descent_.start = brake_.end() + kStandStill;
  descent_.samples[0] = descent_.samples[1] = brake_.samples.back();
  descent_.samples[1].position.z() -= kDeepest_m;
}

const Trajectory& EmergencyLanding::trajectory(TimeNs now) const {
  return now < descent_.start ? brake_ : descent_;
}

}  // namespace karst::core
