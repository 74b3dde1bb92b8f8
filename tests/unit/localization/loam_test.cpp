#include "core_stack/localization/loam.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cstring>

#include "tests/unit/localization/worlds.h"

namespace {

using namespace karst::core;
using namespace karst::test;

constexpr TimeNs kPeriod = 100 * kMillisecond;
constexpr double kNoise = 0.02;

/// Through the furnished room at about 1 m/s, turning and tilting.
Pose lap(TimeNs t) {
  const double s = seconds(t);
  return {{1.5 + 2 * std::cos(0.5 * s), -0.5 + 1.2 * std::sin(0.5 * s), 0.3 * std::sin(0.7 * s)},
          exp_so3({0, 0, 0.4 * s}) * exp_so3({0.1 * std::sin(2 * s), 0.1 * std::cos(1.7 * s), 0})};
}

/// Along x at `speed` from time 0 on.
Motion along_x(double speed_mps) {
  return [=](TimeNs t) {
    return Pose{{speed_mps * seconds(t), 0.3, 0.1}, exp_so3({0.02, -0.03, 0.1 * std::sin(seconds(t))})};
  };
}

struct Flown {
  std::vector<LoamPose> poses;
  double worst_m = 0, worst_rad = 0;
};

/// Sweeps first..last of a motion; the prediction is the truth moved by `error` (body frame).
Flown fly(Loam& loam, const World& world, const Motion& motion, int first, int last, const Pose& error = {},
          bool predicted = true, const std::shared_ptr<LidarModel>& model = lidar(32, 512)) {
  Flown out;
  for (int i = first; i <= last; ++i) {
    const TimeNs stamp = i * kPeriod;
    const Sweep sweep = sweep_of(world, model, motion, stamp, kNoise, static_cast<std::uint64_t>(i));
    out.poses.push_back(loam.process(sweep, predicted ? states_of(motion, stamp, error) : StateHistory{}));
    const PoseError e = error_between(out.poses.back().T_world_body, motion(stamp));
    out.worst_m = std::max(out.worst_m, e.position_m), out.worst_rad = std::max(out.worst_rad, e.angle_rad);
  }
  return out;
}

TEST(Loam, FollowsAFlightInARoomWithinMillimetresWhateverThePredictionsOffset) {
  Loam loam({}, lap(kPeriod));
  fly(loam, furnished_room(), lap, 1, 1);
  const Flown flown =
      fly(loam, furnished_room(), lap, 2, 100, {{0.04, -0.03, 0.02}, exp_so3({0.01, 0, -0.015})});
  for (const LoamPose& p : flown.poses) {
    ASSERT_TRUE(p.valid) << p.problem;
    EXPECT_EQ(p.free_directions, 0);
    EXPECT_EQ(p.problem, "");
  }
  EXPECT_LT(flown.worst_m, 0.012);
  EXPECT_LT(flown.worst_rad, 0.002);
}

TEST(Loam, WithoutAPredictionItHoldsItsOwnVelocity) {
  const auto from_rest = [](TimeNs t) {
    const double s = seconds(t);
    return lap(from_seconds(s * s / (s + 3)));
  };
  for (const ScanToScan scan_to_scan : {ScanToScan::automatic, ScanToScan::never, ScanToScan::always}) {
    LoamOptions o;
    o.scan_to_scan = scan_to_scan;
    Loam loam(o, from_rest(kPeriod));
    const Flown flown = fly(loam, furnished_room(), from_rest, 1, 60, {}, false);
    for (const LoamPose& p : flown.poses) EXPECT_TRUE(p.valid) << p.problem;
    EXPECT_LT(flown.worst_m, 0.03) << name_of(scan_to_scan);
    EXPECT_LT(flown.worst_rad, 0.005) << name_of(scan_to_scan);
  }
}

TEST(Loam, AFirstSweepOfUnknownMotionLeavesTheMapAgain) {
  Loam loam({},
            lap(kPeriod));  // already at 1 m/s and 0.4 rad/s: the first sweep is bent by 5 cm and 2 degrees
  const Flown flown = fly(loam, furnished_room(), lap, 1, 40, {}, false);
  const Pose T_first = flown.poses[2].T_world_body.inverse() * flown.poses.back().T_world_body;
  const PoseError e = error_between(T_first, lap(3 * kPeriod).inverse() * lap(40 * kPeriod));
  EXPECT_LT(e.position_m, 0.03);
  EXPECT_LT(e.angle_rad, 0.012);  // what the second sweep kept of the 2 degrees
}

TEST(Loam, AStraightSmoothTubeLeavesOneDirectionFreeAndItIsHeldFromThePrediction) {
  const Motion motion = along_x(2);
  Loam loam({}, motion(kPeriod));
  fly(loam, tube(2.5, 1.8), motion, 1, 1);
  const Pose error{{0.05, 0.02, 0}, Quat::Identity()};
  const Flown flown = fly(loam, tube(2.5, 1.8), motion, 2, 40, error);
  for (const LoamPose& p : flown.poses) {
    ASSERT_TRUE(p.valid) << p.problem;
    ASSERT_EQ(p.free_directions, 1);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(p.covariance.topLeftCorner<3, 3>());
    EXPECT_GT(std::abs(solver.eigenvectors().col(2).x()), 0.99);
    EXPECT_GT(solver.eigenvalues()[2], 50 * 50);
    EXPECT_LT(solver.eigenvalues()[1], 0.1);
    const Vec3 off = p.T_world_body.position - motion(p.stamp).position;
    EXPECT_NEAR(off.x(), 0.05, 0.01);  // the prediction's
    EXPECT_LT(off.tail<2>().norm(), 0.015);
  }
}

/// An elliptic shaft, 5 m by 3.6 m at z = 0, whose smooth walls lean by 4 to 6 degrees.
World leaning_shaft() {
  return [](const Vec3& origin, const Vec3& direction) {
    constexpr double kLean = 0.04;
    const Eigen::Vector2d o(origin.x() / 2.5, origin.y() / 1.8), d(direction.x() / 2.5, direction.y() / 1.8);
    const double size = 1 + kLean * origin.z(), grows = kLean * direction.z();
    const double a = d.squaredNorm() - grows * grows, b = o.dot(d) - size * grows,
                 c = o.squaredNorm() - size * size;
    return (-b + std::sqrt(b * b - a * c)) / a;
  };
}

// As it was: in a smooth shaft a few matches with tilted normals told a height that was 1.3 m wrong, and the
// vehicle touched the ground.
TEST(Loam, AHeightThatFewMatchesObserveIsTakenFromTheImuIfThereIsOne) {
  const Motion motion = [](TimeNs t) { return Pose{{0.3, 0.1, 2 * seconds(t)}, exp_so3({0.02, -0.03, 0})}; };
  const auto flown = [&](double vertical_fraction, bool predicted) {
    LoamOptions o;
    o.registration.degenerate_fraction_vertical = vertical_fraction;
    Loam loam(o, motion(kPeriod));
    fly(loam, leaning_shaft(), motion, 1, 3, {}, predicted);
    return fly(loam, leaning_shaft(), motion, 4, 40, {{0, 0, 0.05}, Quat::Identity()}, predicted);
  };
  const auto held = [](const Flown& flown) {
    return std::count_if(flown.poses.begin(), flown.poses.end(),
                         [](const LoamPose& p) { return p.valid && p.free_directions == 1; });
  };
  const Flown as_it_is = flown(RegistrationOptions{}.degenerate_fraction_vertical, true),
              by_matches = flown(0.002, true);
  EXPECT_GT(held(as_it_is), 20);  // of 37
  EXPECT_NEAR(as_it_is.worst_m, 0.05, 0.005);
  EXPECT_LT(held(by_matches), 10);
  // Without an IMU the limit does not matter.
  const Flown low = flown(0.002, false), high = flown(0.1, false);
  for (std::size_t i = 0; i < low.poses.size(); ++i)
    EXPECT_EQ(low.poses[i].T_world_body.position, high.poses[i].T_world_body.position) << i;
}

TEST(Loam, ARoundTubeSeenFromItsAxisLeavesRollFreeAsWell) {
  const auto model = lidar(32, 512);
  model->T_body_lidar = {};
  const Motion motion = standing_at({});
  Loam loam({}, {});
  const Flown flown = fly(loam, tube(2, 2), motion, 1, 10, {}, true, model);
  for (std::size_t i = 1; i < flown.poses.size(); ++i) EXPECT_EQ(flown.poses[i].free_directions, 2);
}

TEST(Loam, ALevelFloorLeavesThreeDirectionsFree) {
  const Motion motion = along_x(1);
  Loam loam({}, motion(kPeriod));
  const Flown flown = fly(loam, floor_at(-1.5), motion, 1, 20);
  for (std::size_t i = 1; i < flown.poses.size(); ++i) {
    const LoamPose& p = flown.poses[i];
    ASSERT_TRUE(p.valid) << p.problem;
    EXPECT_EQ(p.free_directions, 3);
    EXPECT_GT(p.covariance(0, 0), 50 * 50);
    EXPECT_GT(p.covariance(1, 1), 50 * 50);
    EXPECT_LT(p.covariance(2, 2), 1e-2);
    EXPECT_LT(std::abs(p.T_world_body.position.z() - 0.1), 0.01);
  }
}

TEST(Loam, PosesHaveTheSameBytesForAnyNumberOfThreads) {
  std::vector<Flown> flown;
  for (const int threads : {1, 2, 4}) {
    LoamOptions o;
    o.threads = threads;
    Loam loam(o, lap(kPeriod));
    flown.push_back(fly(loam, furnished_room(), lap, 1, 30));
  }
  for (std::size_t i = 0; i < flown[0].poses.size(); ++i)
    for (const std::size_t k : {1, 2}) {
      const LoamPose &a = flown[0].poses[i], &b = flown[k].poses[i];
      EXPECT_EQ(a.T_world_body.position, b.T_world_body.position);
      EXPECT_EQ(a.T_world_body.orientation.coeffs(), b.T_world_body.orientation.coeffs());
      EXPECT_EQ(a.covariance, b.covariance);
    }
}

TEST(Loam, HoveringForFiveMinutesAddsNothingToTheMapAndDoesNotDrift) {
  const auto hover = [](TimeNs t) {
    const double s = seconds(t);
    return Pose{{0.1 * std::sin(s), 0.1 * std::cos(1.3 * s), 0.05 * std::sin(2 * s)},
                exp_so3({0.05 * std::sin(3 * s), 0.05 * std::cos(2 * s), 0.2 * s})};
  };
  Loam loam({}, hover(kPeriod));
  const auto model = lidar(16, 256);
  fly(loam, furnished_room(), hover, 1, 1, {}, true, model);
  const std::size_t voxels = loam.map().voxels();
  double late_m = 0;
  for (int i = 2; i <= 3000; i += 4) {
    const Flown flown =
        fly(loam, furnished_room(), hover, i, i, {{0.01, 0, 0}, Quat::Identity()}, true, model);
    ASSERT_TRUE(flown.poses.front().valid) << flown.poses.front().problem;
    if (i > 2800) late_m = std::max(late_m, flown.worst_m);
  }
  EXPECT_EQ(loam.map().keyframes(), 1u);
  EXPECT_EQ(loam.map().voxels(), voxels);
  EXPECT_LT(late_m, 0.012);  // as at first: 4096 beams with 2 cm noise
}

/// A corridor along x with ribs of different lengths every 7 m.
World ribbed_corridor(double length_m) {
  std::vector<Box> ribs;
  Random random(5);
  for (double x = -20; x < length_m + 20; x += 7) {
    const double side = random.uniform() < 0.5 ? -1 : 1, deep = random.uniform(0.4, 1.0);
    ribs.push_back({{x, std::min(side * 4, side * (3 - deep)), -3},
                    {x + random.uniform(0.5, 1.5), std::max(side * 4, side * (3 - deep)), 3}});
  }
  return [ribs](const Vec3& origin, const Vec3& direction) {
    const auto first = static_cast<std::size_t>(std::max(0.0, (origin.x() - 25 + 20) / 7));
    const std::size_t last = std::min(ribs.size(), first + 9);
    double range = crossing({{-1e5, -3, -1.5}, {1e5, 3, 2.5}}, origin, direction).second;
    for (std::size_t i = first; i < last; ++i) {
      const auto [enter, leave] = crossing(ribs[i], origin, direction);
      if (enter <= leave && enter > 0) range = std::min(range, enter);
    }
    return range;
  };
}

TEST(Loam, MemoryStaysFlatOverAKilometre) {
  const Motion motion = along_x(20);
  const auto model = lidar(16, 256, 22.5, 25);
  LoamOptions o;
  o.map.radius_m = 30;
  Loam loam(o, motion(kPeriod));
  const World world = ribbed_corridor(1000);
  std::vector<std::size_t> bytes;
  Flown flown;
  for (int leg = 0; leg < 20; ++leg) {
    flown = fly(loam, world, motion, leg * 25 + 1, leg * 25 + 25, {}, true, model);
    bytes.push_back(loam.map().bytes());
    EXPECT_TRUE(flown.poses.back().valid) << flown.poses.back().problem;
  }
  EXPECT_LE(bytes.back(), *std::max_element(bytes.begin() + 2, bytes.begin() + 6) * 5 / 4);
  EXPECT_LT(bytes.back(), 30u << 20);
  EXPECT_LT(flown.worst_m, 2.0);  // of 1000 m; 0.2 % with 4096 beams and ribs 7 m apart
}

TEST(Loam, VoxelsNeverExceedTheirLimit) {
  LoamOptions o;
  o.map.max_voxels = 3000;
  const Motion motion = along_x(2);
  Loam loam(o, motion(kPeriod));
  const Flown flown = fly(loam, ribbed_corridor(60), motion, 1, 200);
  for (const VoxelGrid& g : loam.map().surfaces()) EXPECT_LE(g.voxels().size(), 3000u);
  EXPECT_TRUE(flown.poses.back().valid) << flown.poses.back().problem;
}

/// A sweep that must be refused: the reason contains `why`, the pose is the prediction, the map is as before.
void expect_refused(Loam& loam, const Sweep& sweep, const StateHistory& predicted, const std::string& why) {
  const std::size_t voxels = loam.map().voxels(), keyframes = loam.map().keyframes();
  const LoamPose p = loam.process(sweep, predicted);
  EXPECT_FALSE(p.valid);
  EXPECT_NE(p.problem.find(why), std::string::npos) << p.problem;
  EXPECT_EQ(p.stamp, sweep.stamp);
  EXPECT_TRUE(p.T_world_body.position.allFinite());
  EXPECT_EQ(loam.map().voxels(), voxels);
  EXPECT_EQ(loam.map().keyframes(), keyframes);
}

class BadSweep : public testing::Test {
 protected:
  void SetUp() override { fly(loam_, furnished_room(), lap, 1, 10); }
  void TearDown() override {  // and afterwards all is as if nothing had been
    const Flown flown = fly(loam_, furnished_room(), lap, 12, 20);
    EXPECT_TRUE(flown.poses.front().valid) << flown.poses.front().problem;
    EXPECT_LT(flown.worst_m, 0.012);
  }
  Sweep next() const { return sweep_of(furnished_room(), lidar(32, 512), lap, stamp_, kNoise); }
  Loam loam_{LoamOptions{}, lap(kPeriod)};
  TimeNs stamp_ = 11 * kPeriod;
  StateHistory predicted_ = states_of(lap, stamp_);
};

TEST_F(BadSweep, WithoutPoints) {
  Sweep sweep = next();
  sweep.points.clear();
  expect_refused(loam_, sweep, predicted_, "too few features");
}

TEST_F(BadSweep, OfThreePoints) {
  Sweep sweep = next();
  sweep.points.resize(3);
  expect_refused(loam_, sweep, predicted_, "too few features");
}

TEST_F(BadSweep, OfNaNs) {
  Sweep sweep = next();
  for (SweepPoint& p : sweep.points) p.position.y() = std::numeric_limits<float>::quiet_NaN();
  expect_refused(loam_, sweep, predicted_, "too few features");
}

TEST_F(BadSweep, AllAtOnePlace) {
  Sweep sweep = next();
  for (SweepPoint& p : sweep.points) p.position = Vec3f(1, 2, 0.5f);
  expect_refused(loam_, sweep, predicted_, "too few features");
}

TEST_F(BadSweep, OfAPastTime) {
  Sweep sweep = next();
  sweep.stamp = 10 * kPeriod;
  expect_refused(loam_, sweep, predicted_, "not newer");
  sweep.stamp = 3 * kPeriod;
  expect_refused(loam_, sweep, predicted_, "not newer");
}

TEST_F(BadSweep, OfAnotherPlace) {
  const auto elsewhere = [](TimeNs) { return Pose{{0, 0, 20}, Quat::Identity()}; };
  const World sphere = [](const Vec3&, const Vec3&) { return 1.0; };
  expect_refused(loam_, sweep_of(sphere, lidar(32, 512), elsewhere, stamp_), predicted_, "");
}

TEST_F(BadSweep, HalfOfItNaNsIsNotBad) {
  Sweep sweep = next();
  for (std::size_t i = 0; i < sweep.points.size(); i += 2)
    sweep.points[i].position.setConstant(std::numeric_limits<float>::quiet_NaN());
  const LoamPose p = loam_.process(sweep, predicted_);
  EXPECT_TRUE(p.valid) << p.problem;
  EXPECT_LT(error_between(p.T_world_body, lap(stamp_)).position_m, 0.015);
}

TEST(Loam, AFirstSweepWithoutRockStartsNoMap) {
  Loam loam({}, lap(kPeriod));
  Sweep nothing;
  nothing.stamp = kPeriod;
  EXPECT_FALSE(loam.process(nothing, StateHistory{}).valid);
  EXPECT_TRUE(loam.map().empty());
  const Flown flown = fly(loam, furnished_room(), lap, 2, 10);
  EXPECT_TRUE(flown.poses.back().valid);
}

TEST(Loam, AfterASecondWithoutScansItFindsBackFromADriftedPrediction) {
  Loam loam({}, lap(kPeriod));
  fly(loam, furnished_room(), lap, 1, 30);
  const Pose drift{{0.3, -0.2, 0.1}, exp_so3({0.02, 0.01, 0.05})};
  const Flown after = fly(loam, furnished_room(), lap, 41, 41, drift);
  ASSERT_TRUE(after.poses.front().valid) << after.poses.front().problem;
  EXPECT_LT(after.worst_m, 0.01);
}

// The process of the vehicle stood still. The prediction flew on, turned, and matched elsewhere.
TEST(Loam, AfterAGapThatWasNotFlownItIsFoundWhereItStopped) {
  Loam loam({}, lap(kPeriod));
  fly(loam, furnished_room(), lap, 1, 30);
  const Motion stopped = standing_at(lap(30 * kPeriod));
  loam.note_gap();
  const Pose flown_on{{2.1, -0.6, 0.1}, exp_so3({0.1, 0.05, 0.8})};
  const Flown after = fly(loam, furnished_room(), stopped, 46, 46, flown_on);
  ASSERT_TRUE(after.poses.front().valid) << after.poses.front().problem;
  EXPECT_LT(after.worst_m, 0.02);
}

TEST(Loam, LostForLongItFindsBackIntoItsMapFromAPredictionThatDrifted) {
  LoamOptions o;
  o.restart_s = 2;
  Loam loam(o, lap(kPeriod));
  fly(loam, furnished_room(), lap, 1, 30);
  const Pose drift{{0.4, -0.3, 0.1}, exp_so3({0.02, 0.01, 0.05})};
  const Flown after = fly(loam, furnished_room(), lap, 90, 90, drift);
  ASSERT_TRUE(after.poses.front().valid) << after.poses.front().problem;
  EXPECT_FALSE(after.poses.front().anew);
  EXPECT_LT(after.worst_m, 0.02) << "most of what it sees there the map does not hold yet";
}

TEST(Loam, LostForLongItBeginsAnewAtThePredictionAndSaysSo) {
  LoamOptions o;
  o.restart_s = 2;
  Loam loam(o, lap(kPeriod));
  fly(loam, furnished_room(), lap, 1, 10);
  const World elsewhere = room({{-9, -3, -2}, {9, 3, 2}});
  const Motion there = standing_at({});
  const Flown lost = fly(loam, elsewhere, there, 11, 40);
  const auto restart =
      std::find_if(lost.poses.begin(), lost.poses.end(), [](const LoamPose& p) { return p.valid; });
  ASSERT_NE(restart, lost.poses.end());
  EXPECT_NEAR(seconds(restart->stamp), 3.1, 0.11);
  EXPECT_NE(restart->problem.find("anew"), std::string::npos);
  EXPECT_TRUE(restart->anew);
  EXPECT_TRUE(lost.poses.back().valid);
  EXPECT_LT(error_between(lost.poses.back().T_world_body, there(0)).position_m, 0.01);
}

}  // namespace
