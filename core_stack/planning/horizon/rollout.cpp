#include "core_stack/planning/horizon/rollout.h"

#include <algorithm>

#include "core_stack/planning/trajectory/heading.h"

namespace karst::core {
namespace {

/// A velocity is approached with this time constant: acceleration fades out.
constexpr double kApproach_s = 0.3;
constexpr double kDt_s = seconds(kRolloutPeriod);

/// The acceleration a period later, if `wanted_mps2` is wanted.
Vec3 next_acceleration(const Vec3& now_mps2, const Vec3& wanted_mps2, const MotionLimits& limits) {
  return now_mps2 + at_most(wanted_mps2 - now_mps2, kDt_s * limits.max_jerk_mps3);
}

}  // namespace

Rollout roll_out(const MotionState& start, const Legs& legs, const MotionLimits& limits,
                 double braking_mps2) {
  HeadingCourse course(start.heading_rad, limits, kDt_s, start.heading_rate_radps);
  Rollout out;
  out.samples.reserve(64);
  out.samples.push_back({start.position, start.heading_rad});
  Vec3 p = start.position, v = start.velocity_mps,
       a = at_most(start.acceleration_mps2, limits.max_acceleration_mps2);
  const double v_max = std::max(limits.max_speed_mps, v.norm());
  const auto move_to = [&](const Vec3& next, double heading_rad) {
    p += 0.5 * kDt_s * (v + next);
    v = next;
    out.samples.push_back({p, course.step(heading_rad)});
  };
  for (const Leg& leg : legs) {
    for (TimeNs t = 0; t < kLeg; t += kRolloutPeriod) {
      const Vec3 wanted = at_most((leg.velocity_mps - v) / kApproach_s, limits.max_acceleration_mps2);
      a = next_acceleration(a, wanted, limits);
      move_to(at_most(v + kDt_s * a, v_max), leg.heading_rad);
    }
  }
  out.end = {p, v, a, course.heading_rad(), course.rate_radps()};
  while (v.norm() > 1e-9) {
    a = next_acceleration(a, -braking_mps2 * v.normalized(), limits);
    const Vec3 next = at_most(v + kDt_s * a, v_max);
    // At the end it stops short of turning round.
    const bool stands = v.norm() <= kDt_s * braking_mps2 || next.dot(v) <= 0;
    move_to(stands ? Vec3::Zero() : next, legs.back().heading_rad);
  }
  return out;
}

}  // namespace karst::core
