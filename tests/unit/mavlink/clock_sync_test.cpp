#include "plugins/mavlink/clock_sync.h"

#include <gtest/gtest.h>

#include <limits>

#include "core_stack/common/random.h"

namespace karst::mavlink {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::TimeNs;

TEST(ClockSync, FindsTheOffsetBehindJitterThatDiffersByDirection) {
  ClockSync sync;
  core::Random random(1);
  constexpr TimeNs kAhead = 1234 * kSecond;
  for (TimeNs t = 0; t < 20 * kSecond; t += kSecond / 10) {
    const TimeNs there = 20 * kMillisecond + core::from_seconds(0.03 * random.uniform()),
                 back = 20 * kMillisecond + core::from_seconds(0.005 * random.uniform());
    sync.note_answer(t, t + there + kAhead, t + there + back);
    if (t < 6 * kSecond) continue;
    EXPECT_LT(std::abs(sync.offset() - kAhead), 3 * kMillisecond);
  }
  EXPECT_NEAR(core::seconds(sync.round_trip()), 0.041, 0.003);
}

TEST(ClockSync, FollowsAClockThatDriftsAndOneThatWasSet) {
  ClockSync sync;
  const auto ask = [&](TimeNs t, TimeNs ahead) {
    sync.note_answer(t, t + 10 * kMillisecond + ahead, t + 20 * kMillisecond);
  };
  TimeNs t = 0;
  for (; t < 60 * kSecond; t += kSecond / 10) ask(t, t / 10000);  // 100 ppm
  EXPECT_LT(std::abs(sync.offset() - t / 10000), kMillisecond);
  ask(t, -5 * kSecond);
  EXPECT_LT(std::abs(sync.offset() + 5 * kSecond), kMillisecond);
}

TEST(ClockSync, IgnoresAnswersThatCannotBe) {
  ClockSync sync;
  sync.note_answer(kSecond, 5 * kSecond, kSecond - 1);
  sync.note_answer(kSecond, 5 * kSecond, 3 * kSecond);
  for (const TimeNs far : {std::numeric_limits<TimeNs>::max(), std::numeric_limits<TimeNs>::min()}) {
    sync.note_answer(far, 5 * kSecond, 3 * kSecond);
    sync.note_answer(kSecond, far, kSecond + 1);
  }
  EXPECT_FALSE(sync.known());
}

}  // namespace
}  // namespace karst::mavlink
