#include "core_stack/planning/horizon/rollout.h"

#include <algorithm>

#include "core_stack/planning/trajectory/heading.h"

namespace karst::core {
namespace {

/// A velocity is approached with this time constant: the jerk of the tracker's reference is limited.
constexpr double kApproach_s = 0.3;

}  // namespace

Rollout roll_out(const MotionState& start, const Legs& legs, const MotionLimits& limits,
                 double braking_mps2) {
  const double dt = seconds(kRolloutPeriod);
  HeadingCourse course(start.heading_rad, limits, dt, start.heading_rate_radps);
  Rollout out;
  out.samples.reserve(64);
  out.samples.push_back({start.position, start.heading_rad});
  Vec3 p = start.position, v = start.velocity_mps;
  for (const Leg& leg : legs) {
    for (TimeNs t = 0; t < kLeg; t += kRolloutPeriod) {
      Vec3 a = (leg.velocity_mps - v) / kApproach_s;
      if (const double norm = a.norm(); norm > limits.max_acceleration_mps2)
        a *= limits.max_acceleration_mps2 / norm;
      p += dt * v + 0.5 * dt * dt * a;
      v += dt * a;
      out.samples.push_back({p, course.step(leg.heading_rad)});
    }
  }
  out.end = {p, v, course.heading_rad(), course.rate_radps()};
  while (v.norm() > 1e-9) {
    const double slower = std::min(v.norm(), dt * braking_mps2);
    const Vec3 next = v - slower * v.normalized();
    p += 0.5 * dt * (v + next);
    v = next;
    out.samples.push_back({p, course.step(legs.back().heading_rad)});
  }
  return out;
}

}  // namespace karst::core
