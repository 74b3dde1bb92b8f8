#include "core_stack/planning/trajectory/polynomial_trajectory.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

#include "core_stack/common/random.h"
#include "core_stack/planning/trajectory/polynomial_times.h"
#include "tests/unit/planning/oracles.h"

namespace karst::core {
namespace {

using testing::distance_to_path, testing::length_of;

bool open_space(const Vec3&, const Vec3&) { return true; }

/// Straights of 1 to 6 m with bends up to a quarter turn between.
std::vector<Vec3> random_path(Random& r, int straights) {
  std::vector<Vec3> out{{r.uniform(-5, 5), r.uniform(-5, 5), r.uniform(-5, 5)}};
  double heading = r.uniform(-3, 3);
  for (int i = 0; i < straights; ++i) {
    heading += r.uniform(-1.5, 1.5);
    const double climb = r.uniform(-0.4, 0.4);
    out.push_back(out.back() + r.uniform(1, 6) * Vec3(std::cos(heading) * std::cos(climb),
                                                      std::sin(heading) * std::cos(climb), std::sin(climb)));
  }
  return out;
}

HeadingPlan keep_heading() {
  HeadingPlan plan;
  plan.along_path = false;
  return plan;
}

/// A quarter turn from +x to +y around the corner (10, 0), rounded as refined paths are.
std::vector<Vec3> bend() {
  std::vector<Vec3> out;
  for (double x = 0; x < 9; x += 0.1) out.push_back({x, 0, 0});
  for (double a = 0; a < 1.57; a += 0.1) out.push_back({9 + std::sin(a), 1 - std::cos(a), 0});
  for (double y = 1; y < 10.05; y += 0.1) out.push_back({10, y, 0});
  return out;
}

TEST(PolynomialTrajectory, LimitsHoldFromTheDepartureToRestAtTheGoal) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random r(seed);
    const std::vector<Vec3> path = random_path(r, 1 + static_cast<int>(r.bits() % 10));
    MotionLimits limits;
    limits.max_speed_mps = r.uniform(0.8, 3);
    limits.max_acceleration_mps2 = r.uniform(1, 3);
    const TimeNs start = 5 * kSecond;
    const PolynomialTrajectory out =
        polynomial_trajectory(path, {}, start, limits, keep_heading(), open_space);
    RC_ASSERT(out.fell_back == "");
    const Trajectory& t = out.trajectory;
    RC_ASSERT(t.start == start);
    RC_ASSERT((t.samples.front().position - path.front()).norm() < 1e-6);
    RC_ASSERT((t.samples.back().position - path.back()).norm() < 1e-6);
    const double dt = seconds(t.period);
    std::vector<Vec3> velocity{Vec3::Zero()}, acceleration;
    for (std::size_t i = 1; i < t.samples.size(); ++i)
      velocity.push_back((t.samples[i].position - t.samples[i - 1].position) / dt);
    // Means over a period can only be less than what they are the means of. The last period is cut short.
    const double most = 1 + kLimitTolerance + 0.01;  // a peak may lie between the places looked at
    for (const Vec3& v : velocity) RC_ASSERT(v.norm() <= most * limits.max_speed_mps);
    for (std::size_t i = 2; i + 1 < velocity.size(); ++i)
      acceleration.push_back((velocity[i] - velocity[i - 1]) / dt);
    for (const Vec3& a : acceleration) RC_ASSERT(a.norm() <= most * limits.max_acceleration_mps2);
    for (std::size_t i = 1; i < acceleration.size(); ++i)
      RC_ASSERT((acceleration[i] - acceleration[i - 1]).norm() / dt <= most * limits.max_jerk_mps3);
    RC_ASSERT(velocity.back().norm() <= limits.max_acceleration_mps2 * dt);
  }));
}

TEST(PolynomialTrajectory, ItGoesOnWithTheVelocityAndAccelerationOfTheDeparture) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random r(seed);
    std::vector<Vec3> path = random_path(r, 5);
    const MotionLimits limits;
    const Vec3 ahead = (path[1] - path[0]).normalized();
    path.insert(path.begin(), path.front() - 2.0 * ahead);
    const Departure departure{r.uniform(0.2, 1.9) * ahead,
                              Vec3(r.uniform(-0.5, 0.5), r.uniform(-0.5, 0.5), r.uniform(-0.5, 0.5))};
    const PolynomialTrajectory out =
        polynomial_trajectory(path, departure, 0, limits, keep_heading(), open_space);
    RC_ASSERT(out.fell_back == "");
    const auto& s = out.trajectory.samples;
    const double dt = seconds(out.trajectory.period);
    // x(dt) = v dt + a dt^2 / 2 + j dt^3 / 6, and no more jerk than allowed.
    const Vec3 expected =
        s[0].position + departure.velocity_mps * dt + 0.5 * departure.acceleration_mps2 * dt * dt;
    RC_ASSERT((s[1].position - expected).norm() <= 1.03 * limits.max_jerk_mps3 * dt * dt * dt / 6);
  }));
}

TEST(PolynomialTrajectory, TheSameQuestionHasTheSameAnswer) {
  const PolynomialTrajectory a = polynomial_trajectory(bend(), {}, 0, {}, keep_heading(), open_space);
  const PolynomialTrajectory b = polynomial_trajectory(bend(), {}, 0, {}, keep_heading(), open_space);
  ASSERT_EQ(a.trajectory.samples.size(), b.trajectory.samples.size());
  for (std::size_t i = 0; i < a.trajectory.samples.size(); ++i)
    EXPECT_EQ(a.trajectory.samples[i].position, b.trajectory.samples[i].position);
}

TEST(PolynomialTrajectory, WhereItWouldTouchRockWaypointsAreAdded) {
  const std::vector<Vec3> path = bend();
  const PolynomialTrajectory free = polynomial_trajectory(path, {}, 0, {}, keep_heading(), open_space);
  double swing = 0;
  for (const TrajectorySample& s : free.trajectory.samples)
    swing = std::max(swing, distance_to_path(path, s.position));
  ASSERT_EQ(free.rounds, 1);
  ASSERT_GT(swing, 0.02);
  // A corridor that leaves less room than the first solution takes.
  const double room = 0.7 * swing;
  const auto corridor = [&](const Vec3& a, const Vec3& b) {
    return distance_to_path(path, a) <= room && distance_to_path(path, b) <= room;
  };
  const PolynomialTrajectory out = polynomial_trajectory(path, {}, 0, {}, keep_heading(), corridor);
  EXPECT_EQ(out.fell_back, "");
  EXPECT_GT(out.rounds, 1);
  EXPECT_GT(out.waypoints, free.waypoints);
  for (const TrajectorySample& s : out.trajectory.samples)
    EXPECT_LE(distance_to_path(path, s.position), room + 0.002);
}

TEST(PolynomialTrajectory, WhereNothingIsClearItIsSampledAndSaysSo) {
  const auto nowhere = [](const Vec3&, const Vec3&) { return false; };
  HeadingPlan plan = keep_heading();
  plan.goal_heading_rad = 1;
  const PolynomialTrajectory out = polynomial_trajectory(bend(), {}, 7, {}, plan, nowhere);
  EXPECT_NE(out.fell_back, "");
  const Trajectory expected = sample_trajectory(bend(), 0, 7, {}, plan);
  ASSERT_EQ(out.trajectory.samples.size(), expected.samples.size());
  for (std::size_t i = 0; i < expected.samples.size(); ++i)
    EXPECT_EQ(out.trajectory.samples[i].position, expected.samples[i].position);
}

TEST(PolynomialTrajectory, WithTooLittleRoomToStopItComesBackToTheGoal) {
  const Vec3 goal(0.3, 0, 0);
  const MotionLimits limits;
  const PolynomialTrajectory out = polynomial_trajectory({{0, 0, 0}, goal}, {{2, 0, 0}, Vec3::Zero()}, 0,
                                                         limits, keep_heading(), open_space);
  double farthest = 0;
  for (const TrajectorySample& s : out.trajectory.samples) farthest = std::max(farthest, s.position.x());
  EXPECT_EQ(out.fell_back, "");
  EXPECT_GT(farthest, 1.0);  // v^2 / (2 a)
  EXPECT_LT((out.trajectory.samples.back().position - goal).norm(), 1e-6);
  // Where there is no room beyond the goal it is sampled: along the path, braking harder than it should.
  const auto no_farther = [&](const Vec3&, const Vec3& b) { return b.x() <= 0.5; };
  EXPECT_NE(polynomial_trajectory({{0, 0, 0}, goal}, {{2, 0, 0}, Vec3::Zero()}, 0, limits, keep_heading(),
                                  no_farther)
                .fell_back,
            "");
}

TEST(PolynomialTrajectory, HeadingKeepsItsLimitsAndEndsAtTheGoals) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random r(seed);
    const std::vector<Vec3> path = random_path(r, 4);
    HeadingPlan plan;
    plan.along_path = r.bits() % 2;
    plan.start_heading_rad = r.uniform(-3, 3);
    if (r.bits() % 2) plan.goal_heading_rad = r.uniform(-3, 3);
    const MotionLimits limits;
    const Trajectory t = polynomial_trajectory(path, {}, 0, limits, plan, open_space).trajectory;
    const double dt = seconds(t.period);
    double rate = 0;
    for (std::size_t i = 1; i < t.samples.size(); ++i) {
      const double next = wrap_angle(t.samples[i].heading_rad - t.samples[i - 1].heading_rad) / dt;
      RC_ASSERT(std::abs(next) <= limits.max_heading_rate_radps + 0.02);
      RC_ASSERT(std::abs(next - rate) <= limits.max_heading_acceleration_radps2 * dt + 0.02);
      rate = next;
    }
    if (plan.goal_heading_rad)
      RC_ASSERT(std::abs(wrap_angle(t.samples.back().heading_rad - *plan.goal_heading_rad)) < 1e-9);
  }));
}

TEST(PolynomialTrajectory, DegeneratePathsWork) {
  const Vec3 p(1, 2, 3);
  EXPECT_TRUE(polynomial_trajectory({}, {}, 7, {}, {}, open_space).trajectory.samples.empty());
  for (const std::vector<Vec3>& path : {std::vector<Vec3>{p},
                                        {p, p},
                                        {p, p + Vec3(1e-9, 0, 0)},
                                        {p, p + Vec3(0.03, 0, 0)},
                                        {p, p + Vec3(1, 0, 0), p}}) {
    const Trajectory t = polynomial_trajectory(path, {}, 7, {}, {}, open_space).trajectory;
    ASSERT_FALSE(t.samples.empty());
    EXPECT_LT((t.samples.back().position - path.back()).norm(), 1e-6);
    for (const TrajectorySample& s : t.samples)
      EXPECT_TRUE(s.position.allFinite() && std::isfinite(s.heading_rad));
  }
}

TEST(PolynomialTrajectory, CornersKeepThePathWithinTheTolerance) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random r(seed);
    std::vector<Vec3> path{Vec3::Zero()};
    for (int i = 0; i < 80; ++i)
      path.push_back(path.back() + Vec3(0.2, r.uniform(-0.1, 0.1), r.uniform(-0.1, 0.1)));
    const std::vector<std::size_t> kept = corners(path, 0.15, 3.0);
    RC_ASSERT(kept.front() == 0u && kept.back() == path.size() - 1);
    std::vector<Vec3> line;
    for (const std::size_t i : kept) line.push_back(path[i]);
    for (const Vec3& p : path) RC_ASSERT(distance_to_path(line, p) <= 0.15 + 1e-9);
    for (std::size_t i = 1; i < kept.size(); ++i) {
      const auto at = [&](std::size_t k) { return path.begin() + static_cast<std::ptrdiff_t>(k); };
      RC_ASSERT(kept[i] > kept[i - 1]);
      RC_ASSERT(length_of({at(kept[i - 1]), at(kept[i] + 1)}) <= 3.0 + 1e-9);
    }
  }));
}

TEST(PolynomialTimes, OptimizedTimesCostLessThanTheGuess) {
  // A metre a second on a straight of 12 m, where twice that is allowed.
  const std::vector<Vec3> line{{0, 0, 0}, {3, 0, 0}, {6, 0, 0}, {9, 0, 0}, {12, 0, 0}};
  const MotionLimits limits;
  const std::vector<double> guess(4, 3.0);
  const auto total = [&](const std::vector<double>& durations) {
    const auto p = within_limits(line, durations, {}, limits);
    return p ? p->duration_s() : 1e9;
  };
  const double before = total(guess), after = total(optimized_times(line, guess, {}, limits, 500));
  EXPECT_NEAR(before, 12, 1e-9);
  EXPECT_LT(after, 9);
  EXPECT_GT(after, 7);  // 12 m at 2 m/s and 2 m/s^2
}

}  // namespace
}  // namespace karst::core
