#include "core_stack/localization/sweep_motion.h"

#include <gtest/gtest.h>

#include "tests/unit/localization/worlds.h"

namespace {

using namespace karst::core;
using namespace karst::test;

/// Turns at 1.5 rad/s about a tilted axis while flying a curve at about 2 m/s.
Pose curve(TimeNs t) {
  const double s = seconds(t);
  return {{2 * s, 0.5 * std::sin(2 * s), 0.3 * s * s}, exp_so3(1.5 * s * Vec3(0.1, 0.2, 1).normalized())};
}

SweepMotion motion_to(const StateHistory& states, const Sweep& sweep) {
  const Pose end = *predicted_pose(states, sweep.stamp);
  return {0.1, sweep.T_body_lidar, [=](double time_s) {
            return end.inverse() * *predicted_pose(states, sweep.stamp + from_seconds(time_s));
          }};
}

TEST(SweepMotion, ASweepOfAMovingSensorLiesOnTheWallsAgain) {
  // Every point of the sweep, moved to the end, must lie on the room's walls as seen from there.
  const Box walls{{-5, -4, -1.5}, {7, 5, 2.5}};
  const Sweep sweep = sweep_of(room(walls), lidar(16, 512), curve, kSecond);
  const SweepMotion motion = motion_to(states_of(curve, kSecond), sweep);
  double worst = 0, worst_as_it_was = 0;
  const auto off_walls = [&](const Vec3& p) {
    return std::abs(std::min((p - walls.low).minCoeff(), (walls.high - p).minCoeff()));
  };
  for (const SweepPoint& p : sweep.points) {
    const Vec3 moved = curve(kSecond) * motion.to_body_at_end(p.position, p.time_s).cast<double>();
    worst = std::max(worst, off_walls(moved));
    worst_as_it_was = std::max(worst_as_it_was,
                               off_walls(curve(kSecond) * (sweep.T_body_lidar * p.position.cast<double>())));
  }
  EXPECT_LT(worst, 0.004);  // half a step of the table: 0.15 mrad at 9 m, and the states' 5 ms chords
  EXPECT_GT(worst_as_it_was, 0.5);
}

TEST(SweepMotion, ATwistLeadsFromOnePoseToTheOther) {
  const Pose a = curve(kSecond), b = curve(kSecond + 100 * kMillisecond);
  const Twist twist = twist_between(a, b, 0.1);
  const PoseError back = error_between(b * pose_after(twist, -0.1), a);
  EXPECT_LT(back.position_m, 1e-12);
  EXPECT_LT(back.angle_rad, 1e-12);
}

TEST(SweepMotion, PosesAreExtrapolatedForThirtyMillisecondsAndNoLonger) {
  const StateHistory states = states_of(curve, kSecond);
  const TimeNs oldest = states.states().front().stamp;
  EXPECT_FALSE(predicted_pose(StateHistory{}, kSecond));
  EXPECT_FALSE(predicted_pose(states, kSecond + 31 * kMillisecond));
  EXPECT_FALSE(predicted_pose(states, oldest - 31 * kMillisecond));
  for (const TimeNs t :
       {kSecond + 20 * kMillisecond, kSecond - 42 * kMillisecond, oldest - 20 * kMillisecond}) {
    const auto pose = predicted_pose(states, t);
    ASSERT_TRUE(pose);
    EXPECT_LT(error_between(*pose, curve(t)).position_m, 0.002);
    EXPECT_LT(error_between(*pose, curve(t)).angle_rad, 0.002);
  }
}

}  // namespace
