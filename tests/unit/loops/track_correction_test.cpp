#include "core_stack/loops/track_correction.h"

#include <gtest/gtest.h>

namespace {

using namespace karst::core;

Pose at(double x, double heading = 0) { return {Vec3(x, 0, 0), from_heading(heading)}; }

TEST(TrackCorrection, WithoutAnchorsNothingChanges) {
  const Pose T{Vec3(1, 2, 3), from_heading(0.3)};
  const Pose same = TrackCorrection()(5, T);
  EXPECT_EQ(same.position, T.position);
  EXPECT_EQ(same.orientation.coeffs(), T.orientation.coeffs());
}

TEST(TrackCorrection, MovesAnAnchorToWhereItBelongs) {
  const TrackCorrection c({{0, at(0), at(0)}, {kSecond, at(4), {Vec3(3, 1, 0), from_heading(0.1)}}});
  EXPECT_LT((c(0, at(0)).position - Vec3::Zero()).norm(), 1e-12);
  const Pose end = c(kSecond, at(4));
  EXPECT_LT((end.position - Vec3(3, 1, 0)).norm(), 1e-12);
  EXPECT_NEAR(heading_of(end.orientation), 0.1, 1e-12);
}

TEST(TrackCorrection, IsRigidAfterTheLastAnchorAndBeforeTheFirst) {
  const TrackCorrection c({{kSecond, at(4), {Vec3(4, 1, 0), from_heading(0.5)}}});
  for (const TimeNs t : {TimeNs{0}, 3 * kSecond}) {
    const Pose p = c(t, at(6));
    EXPECT_LT((p.position - Vec3(4 + 2 * std::cos(0.5), 1 + 2 * std::sin(0.5), 0)).norm(), 1e-12);
    EXPECT_NEAR(heading_of(p.orientation), 0.5, 1e-12);
  }
}

TEST(TrackCorrection, ChangesSteadilyFromOneAnchorToTheNext) {
  const TrackCorrection c({{0, at(0), at(0)},
                           {kSecond, at(4), {Vec3(4, 0.4, 0), from_heading(0.02)}},
                           {2 * kSecond, at(8), {Vec3(8, 0.2, 0.1), from_heading(-0.02)}}});
  Pose last = c(0, at(0));
  for (int i = 1; i <= 200; ++i) {
    const TimeNs t = i * (kSecond / 100);
    const Pose p = c(t, at(4 * seconds(t)));
    EXPECT_NEAR((p.position - last.position).norm(), 0.04, 0.01) << i;  // of 0.04 m flown: no jump anywhere
    last = p;
  }
}

}  // namespace
