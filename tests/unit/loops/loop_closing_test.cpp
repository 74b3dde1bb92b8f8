#include "core_stack/loops/loop_closing.h"

#include <gtest/gtest.h>

#include "core_stack/common/so3.h"
#include "tests/unit/loops/rough_passage.h"

namespace {

using namespace karst::core;
using karst::test::RoughPassage;

/// A walk of `walk_m` along the middle of the passage, by an odometry that drifts: it turns too far by
/// `heading_per_m`, and climbs by `climb` of the path.
struct Walk {
  std::vector<TimeNs> stamps;
  std::vector<Pose> truth, odometry;
};
Walk walk(const RoughPassage& passage, double walk_m, double heading_per_m, double climb,
          const std::function<void(TimeNs, const Pose& odometry, const std::vector<Vec3f>& points)>& see) {
  constexpr double kStep_m = 0.5;
  Walk w;
  Random r(5);
  for (double s = 0; s < walk_m; s += kStep_m) {
    const Pose truth = passage.at(s);
    const Pose drift{Vec3(0, 0, climb * kStep_m), from_heading(heading_per_m * kStep_m)};
    w.odometry.push_back(w.odometry.empty() ? truth
                                            : w.odometry.back() * (w.truth.back().inverse() * truth) * drift);
    w.truth.push_back(truth);
    w.stamps.push_back(from_seconds(s));
    const Pose T_odometry_truth = w.odometry.back() * truth.inverse();
    std::vector<Vec3f> points = passage.rock(s, 12, r);
    for (Vec3f& p : points) p = (T_odometry_truth * p.cast<double>()).cast<float>();
    see(w.stamps.back(), w.odometry.back(), points);
  }
  return w;
}

Walk search(LoopClosing& loops, const RoughPassage& passage, double walk_m, double heading_per_m,
            double climb) {
  Walk w = walk(passage, walk_m, heading_per_m, climb,
                [&](TimeNs t, const Pose& pose, const std::vector<Vec3f>& points) {
                  loops.add({t, pose, true, 0, &points});
                });
  loops.finish();
  return w;
}

double largest_error(const Walk& w, const TrackCorrection& correction) {
  double most = 0;
  for (std::size_t i = 0; i < w.truth.size(); ++i)
    most = std::max(most, (correction(w.stamps[i], w.odometry[i]).position - w.truth[i].position).norm());
  return most;
}

constexpr double kRing_m = 90, kHeadingPerM = 0.0012, kClimb = 0.004;

TEST(LoopClosing, ClosesARingAndTakesTheDriftAway) {
  const RoughPassage ring(kRing_m, true, 0.2, 3);
  LoopClosing loops({}, true, 1);
  const Walk w = search(loops, ring, 1.3 * kRing_m, kHeadingPerM, kClimb);
  EXPECT_GT(largest_error(w, {}), 1);
  EXPECT_GE(loops.closed(), 4u);
  EXPECT_LT(largest_error(w, loops.correction()), 0.35);
  for (const FoundClosure& f : loops.closures()) {
    const Submap &a = loops.submaps()[f.closure.older], &b = loops.submaps()[f.closure.newer];
    const auto truth_at = [&](TimeNs t) { return ring.at(seconds(t)); };
    const Pose truth = truth_at(a.first).inverse() * truth_at(b.first);
    EXPECT_LT((f.closure.T_older_newer.position - truth.position).norm(), 0.1);
    EXPECT_LT(f.closure.T_older_newer.orientation.angularDistance(truth.orientation), 0.02);
  }
}

TEST(LoopClosing, LeavesAPassageWithoutLoopsAsItIs) {
  const RoughPassage straight(400, false, 0.2, 4);
  LoopOptions wide;
  wide.search_m = 1000;  // every earlier place is tried
  LoopClosing loops(wide, true, 1);
  const Walk w = search(loops, straight, 100, kHeadingPerM, kClimb);
  EXPECT_EQ(loops.closed(), 0u);
  const TrackCorrection none = loops.correction();
  for (std::size_t i = 0; i < w.odometry.size(); ++i)
    EXPECT_EQ(none(w.stamps[i], w.odometry[i]).position, w.odometry[i].position);
}

TEST(LoopClosing, LeavesASmoothTubeAsItIs) {
  const RoughPassage tube(kRing_m, true, 0, 3);
  LoopClosing loops({}, true, 1);
  search(loops, tube, 1.3 * kRing_m, kHeadingPerM, 0);
  EXPECT_EQ(loops.closed(), 0u);
}

TEST(LoopClosing, UsesNoClosureThatNoOtherConfirms) {
  const RoughPassage ring(kRing_m, true, 0.2, 3);
  LoopOptions long_submaps;
  long_submaps.submaps.length_m = 18;
  LoopClosing loops(long_submaps, true, 1);
  search(loops, ring, kRing_m + 4, kHeadingPerM, kClimb);  // one submap only overlaps with the first
  ASSERT_EQ(loops.closures().size(), 1u);
  EXPECT_EQ(loops.closures()[0].state, ClosureState::alone);
  EXPECT_EQ(loops.closed(), 0u);
}

TEST(LoopClosing, GivesTheSameBytesWithAnyThreads) {
  const RoughPassage ring(kRing_m, true, 0.2, 3);
  LoopClosing one({}, true, 1), four({}, true, 4);
  search(one, ring, 1.15 * kRing_m, kHeadingPerM, kClimb);
  search(four, ring, 1.15 * kRing_m, kHeadingPerM, kClimb);
  ASSERT_EQ(one.poses().size(), four.poses().size());
  EXPECT_GT(one.closed(), 0u);
  EXPECT_EQ(one.closed(), four.closed());
  for (std::size_t i = 0; i < one.poses().size(); ++i) {
    EXPECT_EQ(one.poses()[i].position, four.poses()[i].position);
    EXPECT_EQ(one.poses()[i].orientation.coeffs(), four.poses()[i].orientation.coeffs());
  }
}

TEST(LoopClosing, MemoryGrowsWithThePathOnly) {
  const RoughPassage straight(400, false, 0.2, 4);
  LoopClosing loops({}, true, 1);
  search(loops, straight, 100, 0, 0);
  EXPECT_LT(static_cast<double>(loops.bytes()) / loops.path_m(), 40'000);  // 40 MB a km
  const std::size_t before = loops.bytes();
  const std::vector<Vec3f> points(1000, Vec3f(100, 1, 0));
  for (int i = 0; i < 1000; ++i) loops.add({from_seconds(200 + i), straight.at(100), true, 0, &points});
  loops.finish();
  EXPECT_LT(loops.bytes() - before, 20'000u);
}

}  // namespace
