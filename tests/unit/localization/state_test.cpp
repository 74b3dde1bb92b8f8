#include "core_stack/localization/state.h"

#include <gtest/gtest.h>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

State state_at(TimeNs stamp, const Vec3& position, double heading_rad = 0) {
  State s;
  s.stamp = stamp;
  s.position = position;
  s.orientation = from_heading(heading_rad);
  return s;
}

TEST(StateHistory, EmptyGivesTheIdentity) {
  const Pose p = StateHistory().pose_at(5);
  EXPECT_EQ(p.position, Vec3::Zero());
  EXPECT_EQ(p.orientation.coeffs(), Quat::Identity().coeffs());
}

TEST(StateHistory, InterpolatesLinearlyAndAlongTheShorterArc) {
  StateHistory h;
  h.push(state_at(100, {0, 0, 0}, 3.0));
  h.push(state_at(200, {1, 2, -4}, -3.0));
  const Pose p = h.pose_at(125);
  EXPECT_LT((p.position - Vec3(0.25, 0.5, -1)).norm(), 1e-12);
  const double arc = 2 * std::numbers::pi - 6.0;
  EXPECT_NEAR(wrap_angle(heading_of(p.orientation) - (3.0 + arc / 4)), 0, 1e-12);
}

TEST(StateHistory, HoldsTheEndsOutsideItsRange) {
  StateHistory h;
  h.push(state_at(100, {1, 0, 0}));
  h.push(state_at(200, {2, 0, 0}));
  EXPECT_EQ(h.pose_at(-50).position.x(), 1);
  EXPECT_EQ(h.pose_at(100).position.x(), 1);
  EXPECT_EQ(h.pose_at(200).position.x(), 2);
  EXPECT_EQ(h.pose_at(900).position.x(), 2);
}

TEST(StateHistory, ForgetsWhatIsOlderThanItsLength) {
  StateHistory h(kSecond);
  for (int i = 0; i <= 300; ++i) h.push(state_at(i * 10 * kMillisecond, {double(i), 0, 0}));
  EXPECT_EQ(h.states().front().stamp, 2 * kSecond);
  EXPECT_EQ(h.states().size(), 101u);
}

TEST(StateHistory, APushIntoThePastReplacesWhatCameAfter) {
  StateHistory h;
  for (int i = 0; i < 5; ++i) h.push(state_at(i * 10, {double(i), 0, 0}));
  h.push(state_at(20, {-7, 0, 0}));
  EXPECT_EQ(h.states().size(), 3u);
  EXPECT_EQ(h.pose_at(40).position.x(), -7);
}

TEST(StateHistory, AgreesWithASearchThroughAllPairs) {
  Random r(3);
  StateHistory h(10 * kSecond);
  TimeNs t = 0;
  for (int i = 0; i < 200; ++i) {
    t += 1 + static_cast<TimeNs>(r.uniform(0, 2e7));
    h.push(state_at(t, {r.normal(), r.normal(), r.normal()}));
  }
  for (int trial = 0; trial < 500; ++trial) {
    const auto q = static_cast<TimeNs>(r.uniform(0, static_cast<double>(t)));
    const auto& s = h.states();
    Vec3 expected = s.front().position;
    for (std::size_t i = 1; i < s.size(); ++i)
      if (s[i - 1].stamp <= q && q <= s[i].stamp)
        expected = s[i - 1].position + (s[i].position - s[i - 1].position) *
                                           (double(q - s[i - 1].stamp) / double(s[i].stamp - s[i - 1].stamp));
    ASSERT_LT((h.pose_at(q).position - expected).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace karst::core
