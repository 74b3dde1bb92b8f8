// Errors worked out by hand, planted drift, and association against trying all.
#include "sdk/evaluation/accuracy/trajectory_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/common/random.h"
#include "sdk/evaluation/accuracy/error_statistics.h"
#include "sdk/evaluation/accuracy/evaluate_run.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using core::from_heading;
using core::Pose;
using core::Vec3;
constexpr double kPi = std::numbers::pi;

TEST(ErrorStatistics, OfKnownNumbers) {
  const ErrorStatistics s = statistics_of({4, 1, 3, 2});
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(30.0 / 4));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(5.0 / 4));
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.max, 4);
  EXPECT_EQ(statistics_of({7, 1, 5}).median, 5);
  EXPECT_EQ(statistics_of({}).count, 0u);
}

TEST(Associate, TakesTheNearestStampOfAll) {
  core::Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<StampedPose> truth, estimate;
    const auto fill = [&](std::vector<StampedPose>& poses, int n) {
      double t = random.uniform();
      for (int i = 0; i < n; ++i, t += random.uniform(0.01, 0.2))
        poses.push_back({t, {Vec3(t, 0, 0), core::Quat::Identity()}});
    };
    fill(truth, 5 + trial % 60);
    fill(estimate, 30);
    const bool longer = estimate.size() > truth.size();
    const auto &few = longer ? truth : estimate, &many = longer ? estimate : truth;
    std::vector<std::pair<double, double>> expected;  // few, many
    for (const StampedPose& p : few) {
      const auto best = std::min_element(many.begin(), many.end(), [&](const auto& a, const auto& b) {
        return std::abs(a.t_s - p.t_s) < std::abs(b.t_s - p.t_s);
      });
      if (std::abs(best->t_s - p.t_s) <= 0.05) expected.emplace_back(p.t_s, best->t_s);
    }
    const auto pairs = associate(truth, estimate, 0.05);
    ASSERT_EQ(pairs.size(), expected.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      EXPECT_EQ(pairs[i].truth.position.x(), longer ? expected[i].first : expected[i].second);
      EXPECT_EQ(pairs[i].estimate.position.x(), longer ? expected[i].second : expected[i].first);
    }
  }
}

TEST(AbsoluteErrors, AreDistanceAndAngleOfTheTwoPoses) {
  const std::vector<PosePair> pairs = {
      {0, {Vec3(1, 2, 3), from_heading(0.5)}, {Vec3(1, 2, 3), from_heading(0.5)}},
      {1, {Vec3(0, 0, 0), from_heading(1.0)}, {Vec3(3, 4, 0), from_heading(1.3)}},
      {2, {Vec3(0, 0, 0), from_heading(3.0)}, {Vec3(0, 0, 2), from_heading(-3.0)}}};
  const PoseErrors e = absolute_errors(pairs);
  EXPECT_NEAR(e.translation_m[0], 0, 1e-12);
  EXPECT_NEAR(e.translation_m[1], 5, 1e-12);
  EXPECT_NEAR(e.translation_m[2], 2, 1e-12);
  EXPECT_NEAR(e.rotation_rad[0], 0, 1e-12);
  EXPECT_NEAR(e.rotation_rad[1], 0.3, 1e-12);
  EXPECT_NEAR(e.rotation_rad[2], 2 * kPi - 6, 1e-12);
}

// The truth goes 1 m forward a step; the estimate goes 1.1 m and turns by 0.1 rad too much, each step:
// (T1^-1 T2)^-1 (E1^-1 E2) = translation (0.1, 0, 0), turn 0.1, in whatever frame either starts.
TEST(RelativeErrors, OfTwoStepsByHandInAnyFrame) {
  const Pose true_step{Vec3(1, 0, 0), from_heading(0)}, step{Vec3(1.1, 0, 0), from_heading(0.1)};
  Pose truth{Vec3(4, 5, 6), from_heading(1)}, estimate{Vec3(-7, 0, 2), from_heading(2)};
  std::vector<PosePair> pairs;
  for (int i = 0; i < 7; ++i) {
    pairs.push_back({0.1 * i, truth, estimate});
    truth = truth * true_step, estimate = estimate * step;
  }
  const PoseErrors one = relative_errors(pairs, pairs_by_frames(pairs.size(), 1));
  ASSERT_EQ(one.translation_m.size(), 6u);
  for (const double e : one.translation_m) EXPECT_NEAR(e, 0.1, 1e-12);
  for (const double e : one.rotation_rad) EXPECT_NEAR(e, 0.1, 1e-12);
  // Two steps: the estimate arrives at 1.1 + 1.1 (cos 0.1, sin 0.1), the truth at (2, 0).
  const PoseErrors two = relative_errors(pairs, pairs_by_frames(pairs.size(), 2));
  ASSERT_EQ(two.translation_m.size(), 3u);
  for (const double e : two.translation_m)
    EXPECT_NEAR(e, std::hypot(1.1 + 1.1 * std::cos(0.1) - 2, 1.1 * std::sin(0.1)), 1e-12);
  for (const double e : two.rotation_rad) EXPECT_NEAR(e, 0.2, 1e-12);
}

TEST(PairsByPath, BeginWhereThePathHasReachedTheLengthOnce) {
  std::vector<PosePair> pairs;
  for (const double x : {0.0, 0.6, 1.2, 1.4, 2.0, 2.3, 3.5, 3.6})
    pairs.push_back({x, {}, {Vec3(x, 0, 0), core::Quat::Identity()}});
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (const IndexPair& p : pairs_by_path(pairs, 1.0)) found.emplace_back(p.from, p.to);
  // Reached at 1.2, at 2.3 (1.1 further) and at 3.5.
  EXPECT_EQ(found, (std::vector<std::pair<std::size_t, std::size_t>>{{2, 5}, {5, 6}}));
}

std::vector<PosePair> straight(double length_m, double step_m, double scale, double heading_radpm) {
  std::vector<PosePair> pairs;
  for (double s = 0; s <= length_m; s += step_m)
    pairs.push_back({s,
                     {Vec3(s, 0, 0), core::Quat::Identity()},
                     {Vec3(scale * s, 0, 0), from_heading(heading_radpm * s)}});
  return pairs;
}

TEST(SegmentDrift, FindsAPlantedScale) {
  for (const auto& [length, unit] : {std::pair{1000.0, 100.0}, {200.0, 10.0}, {20.0, 1.0}}) {
    const SegmentDrift d = segment_drift(straight(length, unit / 40, 1.02, 0));
    EXPECT_EQ(d.unit_m, unit);
    EXPECT_GT(d.segments, 10u);
    EXPECT_NEAR(d.translation_percent, 2.0, 0.1);  // a segment ends up to a step late
    EXPECT_NEAR(d.rotation_radpm, 0, 1e-12);
  }
  EXPECT_EQ(segment_drift(straight(0.5, 0.1, 1, 0)).segments, 0u);
  EXPECT_EQ(segment_drift({}).segments, 0u);
}

TEST(SegmentDrift, FindsAPlantedTurn) {
  const SegmentDrift d = segment_drift(straight(1000, 2.5, 1, 1e-4));
  EXPECT_NEAR(d.rotation_radpm, 1e-4, 2e-6);
}

TEST(HeadingAndEnd, AreThoseOfThePairs) {
  const std::vector<PosePair> pairs = {
      {0, {Vec3(0, 0, 0), from_heading(3.1)}, {Vec3(0, 0, 0), from_heading(-3.1)}},
      {1, {Vec3(3, 0, 0), from_heading(0)}, {Vec3(3, 1, 0), from_heading(0)}}};
  EXPECT_NEAR(*heading_rms_rad(pairs), (2 * kPi - 6.2) / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(*end_error_m(pairs), 1, 1e-12);
  EXPECT_NEAR(true_path_m(pairs), 3, 1e-12);
  EXPECT_FALSE(end_error_m({}));
}

TEST(TrajectoryEvaluation, AlignsAFrameOfItsOwnAndSaysHow) {
  std::vector<StampedPose> truth, estimate;
  const Pose T_estimate_truth{Vec3(10, -20, 3), from_heading(2)};
  for (int i = 0; i < 200; ++i) {
    const double s = 0.1 * i;
    const Pose T{Vec3(10 * std::cos(s / 3), 10 * std::sin(s / 3), 0.2 * s), from_heading(s / 3 + kPi / 2)};
    truth.push_back({s, T});
    estimate.push_back({s + 0.001, T_estimate_truth * T});
  }
  EvaluateOptions options;
  options.own_frame = true;
  const auto e = trajectory_evaluation(truth, estimate, options, "truth.tum");
  EXPECT_EQ(e["pairs"], 200u);
  EXPECT_EQ(e["alignment"]["kind"], "umeyama");
  EXPECT_LT(e["ape"]["translation_m"]["max"].get<double>(), 1e-6);
  EXPECT_LT(e["ape"]["rotation_rad"]["max"].get<double>(), 1e-6);
  EXPECT_LT(e["drift"]["end_error_m"].get<double>(), 0.01);  // stamps a millisecond apart, interpolated
  options.align = false;
  const auto raw = trajectory_evaluation(truth, estimate, options, "truth.tum");
  EXPECT_EQ(raw["alignment"]["kind"], "none");
  EXPECT_GT(raw["ape"]["translation_m"]["min"].get<double>(), 1.0);
  options.max_difference_s = 1e-4;
  EXPECT_THROW(trajectory_evaluation(truth, estimate, options, "truth.tum"), core::InputError);
}

TEST(ReadPoses, KittiMatricesAreTurnedToForwardLeftUp) {
  test::TemporaryDirectory dir;
  // The camera goes 2 m ahead (its z), then turns left by 90 degrees: about its -y.
  dir.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n0 0 -1 0 0 1 0 0 1 0 0 2\n");
  const std::vector<StampedPose> stamps = {{5.0, {}}, {5.1, {}}};
  std::vector<std::string> problems;
  const auto poses = read_poses((dir.path() / "poses.txt").string(), stamps, problems);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].t_s, 5.1);
  EXPECT_LT((poses[1].T_world_body.position - Vec3(2, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR(core::heading_of(poses[1].T_world_body.orientation), kPi / 2, 1e-9);
  dir.write("few.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THROW(read_poses((dir.path() / "few.txt").string(), stamps, problems), core::InputError);
  dir.write("bad.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THROW(read_poses((dir.path() / "bad.txt").string(), stamps, problems), core::InputError);
  EXPECT_THROW(read_poses("/nowhere.tum", stamps, problems), core::InputError);
}

}  // namespace
}  // namespace karst::evaluation
