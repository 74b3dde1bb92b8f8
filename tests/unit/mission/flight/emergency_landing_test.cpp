#include "core_stack/mission/flight/emergency_landing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace karst::core {
namespace {

constexpr double kDescent_mps = 0.4, kRadius_m = 5, kSpeed_mps = 1.5;
constexpr TimeNs kNow = 3 * kSecond;

/// Around a circle of 5 m at 1.5 m/s, heading ahead.
Trajectory circle() {
  Trajectory t;
  t.start = 0;
  for (int i = 0; i < 150; ++i) {
    const double angle = kSpeed_mps * 0.1 * i / kRadius_m;
    t.samples.push_back({kRadius_m * Vec3(std::cos(angle), std::sin(angle), 0.2), angle});
  }
  return t;
}

Vec3 velocity_mps(const EmergencyLanding& landing, TimeNs t) {
  constexpr TimeNs kStep = 10 * kMillisecond;
  const Trajectory& wanted = landing.trajectory(t);
  return (wanted.at(t + kStep).position - wanted.at(t).position) / seconds(kStep);
}

TEST(EmergencyLanding, BrakesOnThePathFasterAndFasterBehindWithinTheStoppingDistance) {
  const MotionLimits limits;
  EmergencyLanding landing(limits, kDescent_mps);
  landing.begin(circle(), kNow);
  const Vec3 from = circle().at(kNow).position;
  EXPECT_LT((landing.trajectory(kNow).at(kNow).position - from).norm(), 1e-9) << "no step in position";
  EXPECT_NEAR(velocity_mps(landing, kNow).norm(), kSpeed_mps, 0.1) << "nor in speed";
  double speed_mps = kSpeed_mps + 0.01, path_m = 0;
  for (TimeNs t = kNow; t < kNow + 2 * kSecond; t += 10 * kMillisecond) {
    const Vec3 p = landing.trajectory(t).at(t).position;
    if (t < kNow + kSecond) {
      EXPECT_NEAR(p.head<2>().norm(), kRadius_m, 2e-3) << "off the path that is known to be free";
      EXPECT_NEAR(p.z(), 0.2 * kRadius_m, 1e-9);
      const double now_mps = velocity_mps(landing, t).norm();
      EXPECT_LT(now_mps, speed_mps + 0.02);
      EXPECT_LT((speed_mps - now_mps) / 0.01, 8 * limits.max_acceleration_mps2) << "in steps of 50 ms";
      speed_mps = now_mps;
      path_m += 0.01 * now_mps;
    }
  }
  EXPECT_LT(speed_mps, 1e-6);
  EXPECT_NEAR(path_m, kSpeed_mps * kSpeed_mps / (2 * 0.95 * limits.max_acceleration_mps2), 0.03);
}

TEST(EmergencyLanding, ThenComesStraightDownAsFarAsTheGroundMayBe) {
  EmergencyLanding landing({}, kDescent_mps);
  landing.begin(circle(), kNow);
  const Vec3 stop = landing.trajectory(kNow + kSecond).at(kNow + kSecond).position;
  for (TimeNs t = kNow + 2 * kSecond; t < kNow + 200 * kSecond; t += kSecond) {
    const Vec3 p = landing.trajectory(t).at(t).position;
    EXPECT_LT((p - stop).head<2>().norm(), 1e-9);
    EXPECT_LT((velocity_mps(landing, t) - Vec3(0, 0, -kDescent_mps)).norm(), 1e-6);
  }
}

TEST(EmergencyLanding, FromAHoverComesDownAtOnceAndIsNotBegunTwice) {
  Trajectory hover;
  hover.samples = {{Vec3(1, 2, 3), 0.5}};
  EmergencyLanding landing({}, kDescent_mps);
  landing.begin(hover, kNow);
  landing.begin(circle(), kNow + kSecond);
  const TimeNs later = kNow + 2 * kSecond;
  const TrajectorySample down = landing.trajectory(later).at(later);
  EXPECT_LT((down.position - Vec3(1, 2, 3 - 1.5 * kDescent_mps)).norm(), 1e-6);
  EXPECT_NEAR(down.heading_rad, 0.5, 1e-12);
}

/// Where it comes down, and when it has come to rest above it.
TEST(EmergencyLanding, FliesTheWayToKnownGroundNotFasterThanAMetrePerSecondAndThenComesDown) {
  Trajectory hover;
  hover.samples = {{{0, 0, 1}, 0.5}};
  const std::vector<Vec3> path{{0.1, 0, 1}, {2, 0, 1}, {2, 2, 1.5}};
  EmergencyLanding landing({}, kDescent_mps);
  landing.prepare(path);
  landing.begin(hover, kNow);
  landing.prepare(std::vector<Vec3>{{0, 0, 1}, {-9, 0, 1}});  // too late
  Vec3 before = landing.trajectory(kNow).at(kNow).position;
  double length_m = 0;
  TimeNs t = kNow;
  for (; before.z() > 0.9 && t < kNow + 60 * kSecond; t += 10 * kMillisecond) {
    const Vec3 p = landing.trajectory(t).at(t).position;
    EXPECT_LT((p - before).norm() / 0.01, 1.02) << "no step, and not too fast";
    length_m += (p - before).norm();
    before = p;
  }
  EXPECT_LT((before - path.back()).head<2>().norm(), 1e-9);
  EXPECT_NEAR(length_m, 2 + std::sqrt(4.25) + 0.6, 0.05);
}

TEST(EmergencyLanding, FliesNoWayOfAnotherMomentOrLongerThanItMay) {
  Trajectory hover;
  hover.samples = {{{0, 0, 1}, 0}};
  for (const auto& [path, longest_m] :
       {std::pair{std::vector<Vec3>{{3, 0, 1}, {4, 0, 1}}, 100.0},
        std::pair{std::vector<Vec3>{{0, 0, 1}, {6, 0, 1}}, 5.0},
        std::pair{std::vector<Vec3>(100, Vec3(1, 0, 1)), 100.0}, std::pair{std::vector<Vec3>{}, 100.0}}) {
    EmergencyLanding landing({}, kDescent_mps);
    landing.prepare(path);
    landing.begin(hover, kNow, longest_m);
    for (TimeNs t = kNow; t < kNow + 10 * kSecond; t += kSecond)
      EXPECT_LT(landing.trajectory(t).at(t).position.head<2>().norm(), 1e-9);
    const TimeNs late = kNow + 10 * kSecond;
    EXPECT_LT(landing.trajectory(late).at(late).position.z(), -1);
  }
}

}  // namespace
}  // namespace karst::core
