#include "sdk/preflight/vehicle/timeline.h"

#include <gtest/gtest.h>

namespace karst::preflight {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::TimeNs;

/// Every `period` for 10 s, 20 ms after it was measured.
std::vector<Arrival> regular(TimeNs period = 100 * kMillisecond) {
  std::vector<Arrival> all;
  for (TimeNs t = period; t <= 10 * kSecond; t += period) all.push_back({t - 20 * kMillisecond, t});
  return all;
}
Timeline of(const std::vector<Arrival>& arrivals) { return timeline_of(arrivals, 0, 10 * kSecond); }

TEST(Timeline, OfARegularSensor) {
  const Timeline t = of(regular());
  EXPECT_EQ(t.messages, 100);
  EXPECT_NEAR(t.rate_hz, 10, 1e-9);
  EXPECT_NEAR(t.longest_gap_s, 0.1, 1e-9);
  EXPECT_NEAR(t.first_after_s, 0.1, 1e-9);
  EXPECT_NEAR(t.jitter_s, 0, 1e-9);
  EXPECT_NEAR(t.latency_s, 0.02, 1e-9);
  EXPECT_NEAR(t.jump_s, 0, 1e-9);
  EXPECT_EQ(t.backward, 0);
  EXPECT_EQ(t.future_s, 0);
  ASSERT_EQ(t.per_second.size(), 10u);
  EXPECT_EQ(t.per_second[4], 10);
}

TEST(Timeline, OfNothing) {
  const Timeline t = of({});
  EXPECT_EQ(t.messages, 0);
  EXPECT_EQ(t.rate_hz, 0);
  EXPECT_NEAR(t.first_after_s, 10, 1e-9);
}

TEST(Timeline, CountsOnlyWhatCameWithinItsTime) {
  EXPECT_EQ(timeline_of(regular(), 2 * kSecond, 4 * kSecond).messages, 21);
}

TEST(Timeline, ASensorThatFallsSilentHasAGapToTheEndAndALowerRate) {
  std::vector<Arrival> a = regular();
  a.resize(50);
  EXPECT_NEAR(of(a).longest_gap_s, 5, 1e-9);
  EXPECT_NEAR(of(a).rate_hz, 49 / 9.9, 1e-9);
}

TEST(Timeline, AGapInTheMiddle) {
  std::vector<Arrival> a = regular();
  a.erase(a.begin() + 30, a.begin() + 37);
  EXPECT_NEAR(of(a).longest_gap_s, 0.8, 1e-9);
}

TEST(Timeline, StampsThatGoBack) {
  std::vector<Arrival> a = regular();
  a[40].stamp = a[39].stamp;
  a[70].stamp = a[60].stamp;
  EXPECT_EQ(of(a).backward, 2);
}

TEST(Timeline, StampsInTheFuture) {
  std::vector<Arrival> a = regular();
  a[40].stamp = a[40].came + 30 * kMillisecond;
  EXPECT_NEAR(of(a).future_s, 0.03, 1e-9);
}

TEST(Timeline, ALastingChangeIsAJumpAndASingleLateMessageIsNone) {
  std::vector<Arrival> once = regular(), lasting = regular();
  once[50].stamp -= 60 * kMillisecond;
  for (std::size_t i = 50; i < lasting.size(); ++i) lasting[i].stamp -= 400 * kMillisecond;
  EXPECT_NEAR(of(once).jump_s, 0, 1e-9);
  EXPECT_NEAR(of(lasting).jump_s, 0.4, 1e-9);
}

TEST(Timeline, IrregularStamps) {
  std::vector<Arrival> a = regular();
  for (std::size_t i = 0; i < a.size(); i += 2) a[i].stamp -= 15 * kMillisecond;
  EXPECT_NEAR(of(a).jitter_s, 0.03, 0.0151) << "intervals of 85 and 115 ms, about the median of one of them";
  EXPECT_GT(of(a).jitter_s, 0.01);
}

}  // namespace
}  // namespace karst::preflight
