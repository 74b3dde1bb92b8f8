// Stamps against the times of recording: damaged ones, clocks that are set, and numbers at the ends of 64
// bits.
#include "plugins/replay/stamp_check.h"

#include <gtest/gtest.h>

#include <limits>

namespace karst::replay {
namespace {

using core::kSecond;
using core::TimeNs;
using Check = StampCheck<int>;

struct Judged {
  std::vector<TimeNs> passed;
  std::vector<int> refused;
  std::vector<TimeNs> set_by;
};
/// Message k is recorded at second k.
Judged judge(const std::vector<TimeNs>& stamps) {
  Check check;
  Judged all;
  const auto add = [&](const Check::Verdict& v) {
    for (const auto& p : v.passed) all.passed.push_back(p.stamp);
    for (const auto& r : v.refused) all.refused.push_back(r.value);
    if (v.set_by != 0) all.set_by.push_back(v.set_by);
  };
  for (std::size_t k = 0; k < stamps.size(); ++k)
    add(check.take({static_cast<int>(k), stamps[k], static_cast<TimeNs>(k) * kSecond}));
  add(check.finish());
  return all;
}
std::vector<TimeNs> seconds(int count, TimeNs offset = 0) {
  std::vector<TimeNs> s;
  for (int k = 0; k < count; ++k) s.push_back(k * kSecond + offset);
  return s;
}

TEST(StampCheck, PassesWhatGoesWithTheRecordingWhateverItsOffset) {
  for (const int count : {0, 1, 4, 5, 40})
    for (const TimeNs offset : {TimeNs{0}, 1'000'000 * kSecond})
      EXPECT_EQ(judge(seconds(count, offset)).passed, seconds(count, offset)) << count;
}

TEST(StampCheck, AStampThatJumpsIsRefusedWhereverItStands) {
  for (int bad = 0; bad < 12; ++bad)
    for (const TimeNs jump : {30 * kSecond, -30 * kSecond}) {
      auto stamps = seconds(12);
      stamps[static_cast<std::size_t>(bad)] += jump;
      const Judged j = judge(stamps);
      EXPECT_EQ(j.refused, std::vector<int>{bad});
      EXPECT_EQ(j.passed.size(), 11u);
      EXPECT_TRUE(j.set_by.empty());
    }
}

TEST(StampCheck, AClockThatIsSetBackGoesOnAndOneThatIsSetForwardJumps) {
  for (const TimeNs jump : {-37 * kSecond, 37 * kSecond}) {
    auto stamps = seconds(40);
    for (std::size_t k = 20; k < 40; ++k) stamps[k] += jump;
    const Judged j = judge(stamps);
    EXPECT_EQ(j.passed, jump < 0 ? seconds(40) : stamps);
    EXPECT_EQ(j.set_by, std::vector<TimeNs>{jump});
    EXPECT_TRUE(j.refused.empty());
  }
}

TEST(StampCheck, JumpsToDifferentTimesAreNoClockThatWasSet) {
  auto stamps = seconds(20);
  for (std::size_t k = 8; k < 15; ++k) stamps[k] += static_cast<TimeNs>(k) * 100 * kSecond;
  const Judged j = judge(stamps);
  EXPECT_EQ(j.refused.size(), 7u);
  EXPECT_EQ(j.passed.size(), 13u);
  EXPECT_TRUE(j.set_by.empty());
}

TEST(StampCheck, TheShiftOfAnotherTopicIsTakenWhereItIsTheSame) {
  Check check;
  for (int k = 0; k < 20; ++k) {
    const TimeNs latency = k % 3 * 5'000'000;
    check.take({k, k * kSecond - (k < 10 ? 0 : 37 * kSecond), k * kSecond + latency}, 37 * kSecond + 1000);
  }
  EXPECT_EQ(check.shift(), 37 * kSecond + 1000);
}

TEST(StampCheck, NumbersAtTheEndsOf64BitsAreJumps) {
  constexpr TimeNs kMost = std::numeric_limits<TimeNs>::max();
  auto stamps = seconds(12);
  stamps[6] = kMost;
  stamps[9] = -kMost;
  EXPECT_EQ(judge(stamps).refused, (std::vector<int>{6, 9}));
  for (std::size_t k = 4; k < 12; ++k) stamps[k] = k % 2 ? kMost : -kMost;
  EXPECT_EQ(judge(stamps).passed.size(), 4u);
}

}  // namespace
}  // namespace karst::replay
