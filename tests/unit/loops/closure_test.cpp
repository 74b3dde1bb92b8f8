#include "core_stack/loops/closure.h"

#include <gtest/gtest.h>

#include "core_stack/common/so3.h"
#include "tests/unit/loops/rough_passage.h"

namespace {

using namespace karst::core;
using karst::test::RoughPassage;

constexpr double kVoxel_m = 0.2;

/// What was seen along 4 m of the passage from `s` on, flown in the direction of `heading`.
Submap submap_at(const RoughPassage& passage, double s, double heading, std::uint64_t seed) {
  Random r(seed);
  SubmapBuilder builder({});
  for (double d = 0; d < 3.9; d += 0.5) {
    const std::vector<Vec3f> points = passage.rock(s + d, 12, r, 6000);
    const Pose middle = passage.at(s + d);
    builder.add(
        {from_seconds(d), {middle.position, middle.orientation * from_heading(heading)}, true, 0, &points});
  }
  return *builder.finish();
}

Closure closure_of(const Submap& older, const Submap& newer, const Pose& guess) {
  Workspace workspace;
  return registered(SubmapRock(older, kVoxel_m), SubmapRock(newer, kVoxel_m), guess, {}, workspace);
}
Pose truth_of(const Submap& older, const Submap& newer) {
  return older.T_world_submap.inverse() * newer.T_world_submap;
}

TEST(Closure, FindsThePoseFromAGuessThatIsOffMostOfAMetreAndSixDegrees) {
  const RoughPassage passage(200, false, 0.25, 3);
  int found = 0;
  for (int i = 0; i < 6; ++i) {
    const double s = 30 + 20 * i;
    const Submap older = submap_at(passage, s, 0, 10), newer = submap_at(passage, s + 2, 3.1, 11);
    const Pose truth = truth_of(older, newer);
    const double side = i % 2 == 0 ? 1 : -1;
    const Pose guess{truth.position + Vec3(0.6 * side, 0.4, 0.2),
                     truth.orientation * from_heading(0.1 * side)};
    const Closure c = closure_of(older, newer, guess);
    if (c.problem.find("direction free") != std::string::npos) continue;  // a smooth stretch
    EXPECT_EQ(c.problem, "") << i;
    ++found;
    EXPECT_GT(c.overlap, 0.8);
    EXPECT_LT((c.T_older_newer.position - truth.position).norm(), 0.03) << i;
    EXPECT_LT(c.T_older_newer.orientation.angularDistance(truth.orientation), 0.005) << i;
    // The covariance is honest: the error lies within three standard deviations.
    const Vec3 error = c.T_older_newer.position - truth.position;
    EXPECT_LT(error.dot(c.covariance.topLeftCorner<3, 3>().inverse() * error), 9 + 6);
  }
  EXPECT_GE(found, 5);
}

TEST(Closure, OfASmoothTubeIsRefusedBecauseItLeavesADirectionFree) {
  const RoughPassage tube(200, false, 0, 3);
  const Submap older = submap_at(tube, 30, 0, 1), newer = submap_at(tube, 80, 0, 2);
  const Closure c = closure_of(older, newer, {});
  EXPECT_NE(c.problem.find("direction free"), std::string::npos) << c.problem;
}

TEST(Closure, OfTwoOtherPlacesIsRefused) {
  const RoughPassage passage(400, false, 0.25, 3);
  for (int i = 0; i < 8; ++i) {
    const Submap older = submap_at(passage, 30 + 11 * i, 0, 1), newer = submap_at(passage, 260 + 9 * i, 0, 2);
    const Closure c = closure_of(older, newer, {});
    EXPECT_NE(c.problem, "") << i << ": overlap " << c.overlap << ", residual " << c.residual_m;
  }
}

TEST(Closure, OfTiltedSubmapsIsRefused) {
  const RoughPassage passage(200, false, 0.25, 3);
  const Submap older = submap_at(passage, 50, 0, 1);
  Submap newer = submap_at(passage, 50, 0, 2);
  std::vector<Vec3f> turned;
  const Quat tilt = exp_so3({0.12, 0, 0});
  for (const Vec3f& p : newer.points()) turned.push_back((tilt * p.cast<double>()).cast<float>());
  newer.packed = packed(turned);
  EXPECT_NE(closure_of(older, newer, {}).problem.find("tilted"), std::string::npos);
}

TEST(Closure, IsRefusedWhereOneFlewThroughTheRockOfTheOther) {
  const RoughPassage passage(200, false, 0.25, 3);
  const Submap older = submap_at(passage, 50, 0, 1);
  Submap newer = submap_at(passage, 50, 0, 2);
  newer.flown.push_back(newer.points().front());
  EXPECT_NE(closure_of(older, newer, {}).problem.find("flown through"), std::string::npos);
}

TEST(Closure, OfASubmapWithoutRockIsRefused) {
  const RoughPassage passage(200, false, 0.25, 3);
  Submap empty;
  empty.flown.push_back(Vec3f::Zero());
  EXPECT_NE(closure_of(submap_at(passage, 50, 0, 1), empty, {}).problem, "");
}

}  // namespace
