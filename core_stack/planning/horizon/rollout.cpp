#include "core_stack/planning/horizon/rollout.h"

#include <algorithm>
#include <cmath>

#include "core_stack/planning/trajectory/heading.h"

namespace karst::core {
namespace {

/// A velocity is approached with this time constant: acceleration fades out.
constexpr double kApproach_s = 0.3;
constexpr double kDt_s = seconds(kRolloutPeriod);

class Point {
 public:
  Point(const MotionState& start, const MotionLimits& limits)
      : limits_(limits),
        course_(start.heading_rad, limits, kDt_s, start.heading_rate_radps),
        p_(start.position),
        v_(start.velocity_mps),
        a_(at_most(start.acceleration_mps2, limits.max_acceleration_mps2)),
        v_max_(std::max(limits.max_speed_mps, v_.norm())) {}

  /// A period of a leg.
  TrajectorySample follow(const Leg& leg) {
    accelerate(at_most((leg.velocity_mps - v_) / kApproach_s, limits_.max_acceleration_mps2));
    return move(at_most(v_ + kDt_s * a_, v_max_), leg.heading_rad);
  }

  TrajectorySample brake(double braking_mps2, double heading_rad) {
    accelerate(-braking_mps2 * v_.normalized());
    const Vec3 next = at_most(v_ + kDt_s * a_, v_max_);
    const bool stands = v_.norm() <= kDt_s * braking_mps2 || next.dot(v_) <= 0;  // it does not turn round
    return move(stands ? Vec3::Zero() : next, heading_rad);
  }

  bool at_rest() const { return v_.norm() < 1e-9; }
  MotionState state() const { return {p_, v_, a_, course_.heading_rad(), course_.rate_radps()}; }

 private:
  void accelerate(const Vec3& wanted_mps2) { a_ += at_most(wanted_mps2 - a_, kDt_s * limits_.max_jerk_mps3); }
  TrajectorySample move(const Vec3& next_mps, double heading_rad) {
    p_ += 0.5 * kDt_s * (v_ + next_mps);
    v_ = next_mps;
    return {p_, course_.step(heading_rad)};
  }

  const MotionLimits& limits_;
  HeadingCourse course_;
  Vec3 p_, v_, a_;
  double v_max_;
};

}  // namespace

Rollout roll_out(const MotionState& start, const Legs& legs, const MotionLimits& limits,
                 double braking_mps2) {
  Point point(start, limits);
  Rollout out;
  out.samples.reserve(64);
  out.samples.push_back({start.position, start.heading_rad});
  for (const Leg& leg : legs)
    for (TimeNs t = 0; t < kLeg; t += kRolloutPeriod) out.samples.push_back(point.follow(leg));
  out.end = point.state();
  while (!point.at_rest()) out.samples.push_back(point.brake(braking_mps2, legs.back().heading_rad));
  return out;
}

MotionState end_of_leg(const MotionState& start, const Leg& leg, const MotionLimits& limits) {
  Point point(start, limits);
  for (TimeNs t = 0; t < kLeg; t += kRolloutPeriod) point.follow(leg);
  return point.state();
}

Vec3 velocity_to(const Vec3& to, const MotionState& s) {
  // v_k = u + r^k (v_0 - u) with r = 1 - dt / tau, summed by the trapezoidal rule and solved for u.
  const double r = 1 - kDt_s / kApproach_s;
  const double lag_s = kApproach_s * (1 + r) / 2 * (1 - std::pow(r, seconds(kLeg) / kDt_s));
  return (to - s.position - lag_s * s.velocity_mps) / (seconds(kLeg) - lag_s);
}

}  // namespace karst::core
