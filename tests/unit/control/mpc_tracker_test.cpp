#include "core_stack/control/mpc_tracker.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

constexpr TimeNs kTick = 10 * kMillisecond;

Trajectory hover(const Vec3& p, double heading_rad = 0) {
  Trajectory t;
  t.samples = {{p, heading_rad}};
  return t;
}

/// Straight lines between random corners at up to 2 m/s, corners taken without slowing down: harder than the
/// planner's own trajectories.
Trajectory random_trajectory(Random& r, TimeNs start, const Vec3& from, int corners) {
  Trajectory t;
  t.start = start;
  Vec3 p = from;
  for (int c = 0; c < corners; ++c) {
    const Vec3 to = p + Vec3(r.uniform(-5, 5), r.uniform(-5, 5), r.uniform(-2, 2));
    const double speed = r.uniform(0.5, 2.0);
    const int n = std::max(1, static_cast<int>((to - p).norm() / (speed * seconds(t.period))));
    for (int i = 0; i < n; ++i)
      t.samples.push_back({p + (to - p) * i / n, std::atan2(to.y() - p.y(), to.x() - p.x())});
    p = to;
  }
  t.samples.push_back({p, 0});
  return t;
}

void expect_within(const Reference& r, const MotionLimits& l) {
  ASSERT_LE(r.velocity_mps.norm(), l.max_speed_mps);
  ASSERT_LE(r.acceleration_mps2.norm(), l.max_acceleration_mps2);
  ASSERT_LE(r.jerk_mps3.norm(), l.max_jerk_mps3);
  ASSERT_LE(std::abs(r.heading_rate_radps), l.max_heading_rate_radps + 1e-12);
}

TEST(MpcTracker, NeverExceedsItsLimitsAlongRoughTrajectories) {
  const MotionLimits limits;
  MpcTracker tracker({}, limits);
  Random r(21);
  tracker.reset(0, Vec3::Zero(), 0);
  TimeNs now = 0;
  for (int leg = 0; leg < 12; ++leg) {
    // A new trajectory every few seconds, begun up to a metre from where the last one was left.
    const Vec3 from = tracker.reference().position + Vec3(r.uniform(-0.6, 0.6), r.uniform(-0.6, 0.6), 0);
    const Trajectory t = random_trajectory(r, now, from, 3);
    Reference before = tracker.reference();
    for (int i = 0; i < 500; ++i) {
      now += kTick;
      const Reference& ref = tracker.step(t, now);
      expect_within(ref, limits);
      // It is one smooth motion: position and velocity are integrals of what the reference says.
      const double dt = seconds(kTick);
      ASSERT_LT((ref.position - before.position - before.velocity_mps * dt).norm(),
                limits.max_acceleration_mps2 * dt * dt);
      ASSERT_LT((ref.velocity_mps - before.velocity_mps).norm(), limits.max_acceleration_mps2 * dt + 1e-9);
      ASSERT_LT((ref.acceleration_mps2 - before.acceleration_mps2).norm(), limits.max_jerk_mps3 * dt + 1e-9);
      before = ref;
    }
  }
}

RC_GTEST_PROP(MpcTracker, LimitsHoldForOtherLimitsToo, (std::uint64_t seed)) {
  Random r(seed);
  MotionLimits limits;
  limits.max_speed_mps = r.uniform(0.5, 6);
  limits.max_acceleration_mps2 = r.uniform(0.5, 5);
  limits.max_jerk_mps3 = r.uniform(5, 40);
  MpcTracker tracker({}, limits);
  tracker.reset(0, Vec3::Zero(), 0);
  TimeNs now = 0;
  const Trajectory t = random_trajectory(r, now, Vec3(r.uniform(-2, 2), 0, 0), 4);
  for (int i = 0; i < 60; ++i) {
    now += kTick;
    const Reference& ref = tracker.step(t, now);
    RC_ASSERT(ref.velocity_mps.norm() <= limits.max_speed_mps);
    RC_ASSERT(ref.acceleration_mps2.norm() <= limits.max_acceleration_mps2);
    RC_ASSERT(ref.jerk_mps3.norm() <= limits.max_jerk_mps3);
  }
}

TEST(MpcTracker, StepOfFiveMetresOvershootsByLessThanACentimetreAndComesToRest) {
  const MotionLimits limits;
  for (const Vec3& goal : {Vec3(5, 0, 0), Vec3(0, 0, 5), Vec3(3, -4, 0), Vec3(2.9, 2.9, 2.9)}) {
    MpcTracker tracker({}, limits);
    tracker.reset(0, Vec3::Zero(), 0);
    double farthest = 0, fastest = 0;
    for (TimeNs now = kTick; now <= 10 * kSecond; now += kTick) {
      const Reference& ref = tracker.step(hover(goal), now);
      expect_within(ref, limits);
      farthest = std::max(farthest, ref.position.dot(goal.normalized()));
      fastest = std::max(fastest, ref.velocity_mps.norm());
    }
    EXPECT_LT(farthest, goal.norm() + 0.01);
    EXPECT_GT(fastest, 0.95 * limits.max_speed_mps) << "the speed allowed is used in every direction";
    EXPECT_LT((tracker.reference().position - goal).norm(), 1e-4);
    EXPECT_LT(tracker.reference().velocity_mps.norm(), 1e-4);
    EXPECT_LT(tracker.reference().acceleration_mps2.norm(), 1e-3);
  }
}

TEST(MpcTracker, FollowsASmoothTrajectoryClosely) {
  const MotionLimits limits;
  MpcTracker tracker({}, limits);
  Trajectory t;
  t.period = 200 * kMillisecond;
  const double radius = 2.5, rate = 1.8 / radius;  // 1.8 m/s, 1.3 m/s^2
  for (int i = 0; i < 150; ++i) {
    const double a = rate * i * seconds(t.period);
    t.samples.push_back({{radius * std::cos(a), radius * std::sin(a), 0}, wrap_angle(a)});
  }
  tracker.reset(0, t.samples[0].position, 0);
  double sum = 0;
  int n = 0;
  for (TimeNs now = kTick; now <= 25 * kSecond; now += kTick) {
    const Reference& ref = tracker.step(t, now);
    if (now < 5 * kSecond) continue;
    sum += (ref.position - t.at(now).position).squaredNorm();
    ASSERT_LT(std::abs(wrap_angle(ref.heading_rad - t.at(now).heading_rad)), 0.02);
    ++n;
  }
  EXPECT_LT(std::sqrt(sum / n), 0.03);
}

TEST(MpcTracker, WithoutSamplesItStaysWhereItWasAsked) {
  MpcTracker tracker({}, {});
  tracker.reset(5 * kSecond, {1, 2, 3}, 0.7);
  for (int i = 1; i < 100; ++i) tracker.step(Trajectory{}, 5 * kSecond + i * kTick);
  EXPECT_LT((tracker.reference().position - Vec3(1, 2, 3)).norm(), 1e-9);
  EXPECT_NEAR(tracker.reference().heading_rad, 0.7, 1e-9);
}

TEST(MpcTracker, ResetForgetsThePast) {
  MpcTracker used({}, {}), fresh({}, {});
  used.reset(0, Vec3::Zero(), 0);
  for (int i = 1; i < 100; ++i) used.step(hover({4, 0, 0}), i * kTick);
  used.reset(kSecond, {1, 1, 1}, 0.2);
  fresh.reset(kSecond, {1, 1, 1}, 0.2);
  for (int i = 1; i < 50; ++i) {
    const Reference& a = used.step(hover({0, 2, 1}), kSecond + i * kTick);
    const Reference& b = fresh.step(hover({0, 2, 1}), kSecond + i * kTick);
    ASSERT_EQ(a.position, b.position);
    ASSERT_EQ(a.jerk_mps3, b.jerk_mps3);
  }
}

TEST(MpcTracker, ATickThatDidNotAdvanceTimeChangesNothing) {
  MpcTracker tracker({}, {});
  tracker.reset(0, Vec3::Zero(), 0);
  tracker.step(hover({1, 0, 0}), kTick);
  const Reference once = tracker.step(hover({1, 0, 0}), 2 * kTick);
  const Reference again = tracker.step(hover({1, 0, 0}), 2 * kTick);
  EXPECT_EQ(once.position, again.position);
  EXPECT_EQ(once.acceleration_mps2, again.acceleration_mps2);
}

}  // namespace
}  // namespace karst::core
