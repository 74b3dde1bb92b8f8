// Roll-out: the motion of a point with limited speed, acceleration, jerk and heading rate that follows a few
// legs, and then stops.
#pragma once
#include <array>
#include <vector>

#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {

/// For one leg the vehicle steers to this velocity and this heading.
struct Leg {
  Vec3 velocity_mps = Vec3::Zero();
  double heading_rad = 0;
};
constexpr int kLegs = 3;
constexpr TimeNs kLeg = kSecond, kRolloutPeriod = 100 * kMillisecond;
using Legs = std::array<Leg, kLegs>;

struct MotionState {
  Vec3 position = Vec3::Zero(), velocity_mps = Vec3::Zero(), acceleration_mps2 = Vec3::Zero();
  double heading_rad = 0, heading_rate_radps = 0;
};

struct Rollout {
  std::vector<TrajectorySample> samples;  // every kRolloutPeriod; the first is the start, the last at rest
  MotionState end;                        // of the last leg, before it brakes
};

/// The motion at the end of one leg.
MotionState end_of_leg(const MotionState& start, const Leg& leg, const MotionLimits& limits);
/// The velocity of a leg from `s` that ends at `to`, were accelerations not limited.
Vec3 velocity_to(const Vec3& to, const MotionState& s);

/// Speeds stay within the limits if those of the legs and of the start do. It brakes with `braking_mps2`.
Rollout roll_out(const MotionState& start, const Legs& legs, const MotionLimits& limits, double braking_mps2);

}  // namespace karst::core
