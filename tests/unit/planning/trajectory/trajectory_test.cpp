#include "core_stack/planning/trajectory/trajectory.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core_stack/common/random.h"
#include "tests/unit/planning/oracles.h"

namespace karst::core {
namespace {

using testing::distance_to_path, testing::length_of;

/// A smooth random path: headings and climbs that wander within the given curvature.
std::vector<Vec3> smooth_path(Random& random, double length_m, double curvature) {
  std::vector<Vec3> out{Vec3(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5))};
  double heading = random.uniform(-3, 3), climb = 0, turn = 0;
  for (double s = 0; s < length_m; s += 0.1) {
    if (out.size() % 10 == 1) turn = random.uniform(-curvature, curvature);
    heading += 0.1 * turn;
    climb = 0.3 * std::sin(0.5 * s);
    out.push_back(out.back() + 0.1 * Vec3(std::cos(heading) * std::cos(climb),
                                          std::sin(heading) * std::cos(climb), std::sin(climb)));
  }
  return out;
}

TEST(Trajectory, SpeedAndAccelerationStayWithinTheLimitsAndItEndsAtRestAtTheGoal) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    const std::vector<Vec3> path = smooth_path(random, random.uniform(2, 30), 1.0);
    MotionLimits limits;
    limits.max_speed_mps = random.uniform(0.5, 3);
    HeadingPlan keep;
    keep.along_path = false;
    // No faster than the sharpest bend allows and the path's end can be reached with.
    const double v0 =
        random.uniform(0, std::min({1.2, limits.max_speed_mps, 1.5 * std::sqrt(length_of(path))}));
    const Trajectory t = sample_trajectory(path, v0, 5 * kSecond, limits, keep);
    RC_ASSERT(t.samples.front().position == path.front());
    RC_ASSERT(t.samples.back().position == path.back());
    const double dt = seconds(t.period), a_max = limits.max_acceleration_mps2;
    const auto velocity = [&](std::size_t i) {
      return Vec3((t.samples[i + 1].position - t.samples[i].position) / dt);
    };
    const std::size_t steps = t.samples.size() - 1;
    for (std::size_t i = 0; i < steps; ++i) {
      RC_ASSERT(velocity(i).norm() <= limits.max_speed_mps * 1.001 + 1e-9);
      RC_ASSERT(distance_to_path(path, t.samples[i].position) < 0.02);
    }
    for (std::size_t i = 1; i < steps; ++i) {
      const Vec3 a = (velocity(i) - velocity(i - 1)) / dt,
                 along = (velocity(i) + velocity(i - 1)).normalized();
      // Curvature that jumps between nodes is met late by up to half a node: a quarter more than the limit.
      RC_ASSERT(std::abs(a.dot(along)) <= 1.25 * a_max);
      RC_ASSERT((a - a.dot(along) * along).norm() <= 1.25 * a_max + 1e-6);
    }
    // At rest in the end: no faster in the last step than a_max can have left, and started as asked.
    RC_ASSERT(velocity(steps - 1).norm() <= a_max * dt * 1.01);
    RC_ASSERT(std::abs(velocity(0).norm() - v0) <= a_max * dt * 1.25 + 1e-6);
  }));
}

TEST(Trajectory, ProgressAlongAStraightIsMonotonicAndAsFastAsPossible) {
  const Trajectory t = sample_trajectory({{0, 0, 0}, {10, 0, 0}}, 0, 0, {}, {});
  for (std::size_t i = 1; i < t.samples.size(); ++i)
    EXPECT_GE(t.samples[i].position.x(), t.samples[i - 1].position.x());
  // 2 m/s at 2 m/s^2: a second up, a second down, 8 m at full speed.
  EXPECT_NEAR(seconds(t.end()), 6.0, 0.101);
}

TEST(Trajectory, StopsExactlyAtTheGoalFromSpeed) {
  const Trajectory t = sample_trajectory({{0, 0, 0}, {1.0, 0, 0}}, 2.0, 0, {}, {});
  EXPECT_NEAR(seconds(t.end()), 1.0, 0.101);  // v^2 / (2 a) = 1 m takes v / a = 1 s
  EXPECT_NEAR(t.at(500 * kMillisecond).position.x(), 0.75, 0.01);
  EXPECT_EQ(t.samples.back().position, Vec3(1, 0, 0));
}

TEST(Trajectory, ArrivingTooFastForABendItBrakesAllItCan) {
  std::vector<Vec3> bend;
  for (double a = 0; a < std::numbers::pi / 2; a += 0.1)
    bend.push_back({0.4 * std::sin(a), 0.4 - 0.4 * std::cos(a), 0});
  for (double y = 0.5; y < 4; y += 0.1) bend.push_back({0.4, y, 0});
  HeadingPlan keep;
  keep.along_path = false;
  const Trajectory t = sample_trajectory(bend, 2.0, 0, {}, keep);
  double before = 2.0;
  for (std::size_t i = 1; i < 5; ++i) {
    const double v = (t.samples[i].position - t.samples[i - 1].position).norm() / 0.1;
    EXPECT_NEAR(v, before - (i == 1 ? 0.1 : 0.2), 0.08);  // 2 m/s^2 for 0.1 s; the first step begins at 2 m/s
    before = v;
  }
}

// As it was: told to be slow, a vehicle of 5 m/s was to fly 2 m/s at once.
TEST(Trajectory, FasterThanAllowedItBrakesAllItCan) {
  MotionLimits limits;
  SlowPlaces fast;
  fast.trusted.sight_mps = fast.trusted.room_mps = {10};
  const Trajectory t = sample_trajectory({{0, 0, 0}, {40, 0, 0}}, 5, 0, limits, {}, fast);
  double before_mps = 5;
  for (std::size_t i = 1; i < t.samples.size(); ++i) {
    const double v = (t.samples[i].position - t.samples[i - 1].position).norm() / seconds(t.period);
    EXPECT_GT(v, before_mps - 1.05 * limits.max_acceleration_mps2 * seconds(t.period) - 1e-3) << i;
    before_mps = v;
  }
  EXPECT_GT((t.samples[4].position - t.samples[3].position).norm() / seconds(t.period),
            limits.max_speed_mps + 1);
}

TEST(Trajectory, TheGreatestStartSpeedIsThatFromWhichBendAndEndCanBeMet) {
  const MotionLimits limits;
  EXPECT_NEAR(greatest_start_speed_mps({{0, 0, 0}, {0.5, 0, 0}}, limits), std::sqrt(2.0),
              1e-9);  // v^2 = 2 a s
  EXPECT_EQ(greatest_start_speed_mps({{0, 0, 0}, {5, 0, 0}}, limits), limits.max_speed_mps);
  // A turn back, which is flown at v_min.
  const double least = limits.min_speed_mps;
  EXPECT_NEAR(greatest_start_speed_mps({{0, 0, 0}, {0.4, 0, 0}, {-5, 0, 0}}, limits),
              std::sqrt(least * least + 2 * limits.max_acceleration_mps2 * 0.4), 0.2);
  EXPECT_EQ(greatest_start_speed_mps({{1, 2, 3}}, limits), limits.max_speed_mps) << "nothing to be flown";
}

TEST(Trajectory, SlowsDownInBends) {
  std::vector<Vec3> bend;
  for (double x = 0; x < 5; x += 0.1) bend.push_back({x, 0, 0});
  for (double a = 0; a < std::numbers::pi / 2; a += 0.1)
    bend.push_back({5 + std::sin(a), 1 - std::cos(a), 0});
  for (double y = 1; y < 6; y += 0.1) bend.push_back({6, y, 0});
  HeadingPlan keep;
  keep.along_path = false;
  const Trajectory t = sample_trajectory(bend, 0, 0, {}, keep);
  double in_bend = 10;
  for (std::size_t i = 1; i < t.samples.size(); ++i)
    if (t.samples[i].position.x() > 5.3 && t.samples[i].position.y() < 0.7)
      in_bend = std::min(in_bend, (t.samples[i].position - t.samples[i - 1].position).norm() / 0.1);
  EXPECT_NEAR(in_bend, std::sqrt(2.0), 0.15);  // v^2 / r = a_max with r = 1 m
}

TEST(Trajectory, DegeneratePathsWork) {
  const Vec3 p(1, 2, 3);
  HeadingPlan plan;
  plan.start_heading_rad = 0.4;
  EXPECT_TRUE(sample_trajectory({}, 0, 7, {}, plan).samples.empty());
  for (const std::vector<Vec3>& path : {std::vector<Vec3>{p}, {p, p}, {p, p, p}, {p, p + Vec3(1e-9, 0, 0)}}) {
    const Trajectory t = sample_trajectory(path, 0, 7, {}, plan);
    ASSERT_FALSE(t.samples.empty());
    EXPECT_LT((t.samples.back().position - p).norm(), 1e-8);
    EXPECT_NEAR(t.samples.back().heading_rad, 0.4, 1e-12);
  }
  std::vector<Vec3> stutter;
  for (int i = 0; i < 200; ++i) stutter.push_back(p + Vec3(0.001 * (i / 7), 0, 0.002 * (i / 50)));
  const Trajectory t = sample_trajectory(stutter, 0.5, 7, {}, plan);
  for (const TrajectorySample& s : t.samples)
    EXPECT_TRUE(s.position.allFinite() && std::isfinite(s.heading_rad));
  EXPECT_EQ(t.samples.back().position, stutter.back());
}

TEST(Trajectory, HeadingFollowsThePathWithinItsRate) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    const std::vector<Vec3> path = smooth_path(random, random.uniform(2, 20), 1.0);
    HeadingPlan plan;
    plan.start_heading_rad = random.uniform(-3, 3);
    if (random.bits() % 2) plan.goal_heading_rad = random.uniform(-3, 3);
    if (random.bits() % 2) plan.passing = {path[path.size() / 2], random.uniform(-3, 3)};
    const MotionLimits limits;
    const Trajectory t = sample_trajectory(path, 0, 0, limits, plan);
    double rate = 0;
    const double dt = seconds(t.period);
    for (std::size_t i = 1; i < t.samples.size(); ++i) {
      const double next = wrap_angle(t.samples[i].heading_rad - t.samples[i - 1].heading_rad) / dt;
      // The very last step may close a remainder of a milliradian.
      RC_ASSERT(std::abs(next) <= limits.max_heading_rate_radps + 0.02);
      RC_ASSERT(std::abs(next - rate) <= limits.max_heading_acceleration_radps2 * dt + 0.02);
      rate = next;
    }
    if (plan.goal_heading_rad)
      RC_ASSERT(std::abs(wrap_angle(t.samples.back().heading_rad - *plan.goal_heading_rad)) < 1e-9);
  }));
}

TEST(Trajectory, TurnsOnTheSpotBeforeFlyingBackwards) {
  HeadingPlan plan;
  plan.start_heading_rad = std::numbers::pi;
  const Trajectory t = sample_trajectory({{0, 0, 0}, {5, 0, 0}}, 0, 0, {}, plan);
  for (const TrajectorySample& s : t.samples)
    EXPECT_TRUE(std::abs(wrap_angle(s.heading_rad)) <= 0.7 || s.position == Vec3::Zero());
  EXPECT_NEAR(t.samples.back().heading_rad, 0.0, 1e-2);
}

TEST(Trajectory, LooksInPassingWhereItIsToldTo) {
  HeadingPlan plan;
  plan.passing = {{6, 0, 0}, 1.5};
  const std::vector<Vec3> path{{0, 0, 0}, {12, 0, 0}};
  const Trajectory t = sample_trajectory(path, 0, 0, {}, plan);
  double min_off = 10;
  for (const TrajectorySample& s : t.samples) {
    if (std::abs(s.position.x() - 6) < 0.2) min_off = std::min(min_off, std::abs(s.heading_rad - 1.5));
    EXPECT_TRUE(std::abs(s.position.x() - 6) < 3 || std::abs(s.heading_rad) < 0.1) << s.position.x();
  }
  EXPECT_LT(min_off, 0.4);
  plan.passing.reset();
  EXPECT_LT(t.end() - sample_trajectory(path, 0, 0, {}, plan).end(), 3 * kSecond) << "without a stop";
}

TEST(Trajectory, AtInterpolatesAndHoldsTheEnds) {
  Trajectory t;
  t.start = kSecond;
  t.period = kSecond;
  t.samples = {{{0, 0, 0}, 3.0}, {{1, 0, 0}, -3.0}};
  EXPECT_EQ(t.at(0).position.x(), 0);
  EXPECT_NEAR(t.at(kSecond + kSecond / 4).position.x(), 0.25, 1e-12);
  EXPECT_NEAR(std::abs(t.at(kSecond + kSecond / 2).heading_rad), std::numbers::pi,
              1e-9);  // over the shorter arc
  EXPECT_EQ(t.at(9 * kSecond).position.x(), 1);
  EXPECT_EQ(Trajectory{}.at(0).position, Vec3::Zero());
}

TEST(SampleTrajectory, IsSlowNearSlowPlacesAndNowhereElse) {
  // As it was: a way home of 127 m with one narrow place was flown slowly from end to end, and the battery
  // ended.
  const MotionLimits limits;
  const std::vector<Vec3> points{{0, 0, 0}, {60, 0, 0}};
  HeadingPlan straight;
  straight.along_path = false;
  const SlowPlaces slow{{{30, 0.1, 0}, {30.5, 0.1, 0}}, 1.0, 0.8};
  const Trajectory with = sample_trajectory(points, 0, 0, limits, straight, slow),
                   without = sample_trajectory(points, 0, 0, limits, straight);
  for (std::size_t i = 1; i < with.samples.size(); ++i) {
    const double x = with.samples[i].position.x();
    const double speed = (x - with.samples[i - 1].position.x()) / seconds(with.period);
    if (x > 29.2 && x < 31.3) {
      EXPECT_LT(speed, 0.85) << x;
    }
    if ((x > 3 && x < 27) || (x > 34 && x < 57)) {
      EXPECT_GT(speed, 1.9) << x;
    }
  }
  EXPECT_LT(seconds(with.end() - without.end()), 4);
}

/// Speeds that a goal asked for once: the samples went on until memory was gone.
TEST(Trajectory, ThatWouldTakeForEverEndsAtRestOnThePathWithinTwoHours) {
  const std::vector<Vec3> path{{0, 0, 0}, {30, 0, 0}, {30, 40, 0}};
  for (const double speed_mps : {0.0, 1e-300, 1e-9, 1e-4, 1e-3, 5e-3})
    for (const double start_mps : {0.0, 1.5}) {
      MotionLimits limits;
      limits.max_speed_mps = limits.min_speed_mps = speed_mps;
      HeadingPlan heading;
      heading.goal_heading_rad = 1.0;
      const Trajectory t = sample_trajectory(path, start_mps, kSecond, limits, heading);
      ASSERT_GE(t.samples.size(), 1u);
      ASSERT_LE(seconds(t.end() - t.start), 7300) << speed_mps;
      for (const TrajectorySample& s : t.samples)
        ASSERT_LT(distance_to_path(path, s.position), 0.03) << speed_mps;
      EXPECT_TRUE(t.samples.front().position == path.front());
      const std::size_t n = t.samples.size();
      if (n > 1) {
        EXPECT_LT((t.samples[n - 1].position - t.samples[n - 2].position).norm(), 0.02);
      }
      const double flown_m = (t.samples.back().position - path.front()).norm();
      if (speed_mps >= 1e-3) {
        EXPECT_NEAR(flown_m, std::min(50.0, 7200 * speed_mps), 0.2 + 0.3 * flown_m);
      }
    }
}

}  // namespace
}  // namespace karst::core
