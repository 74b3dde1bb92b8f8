#include "core_stack/perception/scan_clock.h"

#include <gtest/gtest.h>

#include <functional>

namespace karst::core {
namespace {

constexpr TimeNs kPeriod = 100 * kMillisecond, kLag = 20 * kMillisecond;

/// Ten scans a second; `stamp_of` is what the scanner writes on one taken at a time.
struct Scanner {
  ScanClock clock;
  int used = 0, refused = 0;
  TimeNs worst_off = 0;  // of the stamps used, from the truth

  void run(
      TimeNs first, TimeNs last, const std::function<TimeNs(TimeNs taken)>& stamp_of,
      const std::function<TimeNs(TimeNs taken)>& lag_of = [](TimeNs) { return kLag; }) {
    for (TimeNs taken = first; taken <= last; taken += kPeriod) {
      const auto stamp = clock.taken_at(stamp_of(taken), taken + lag_of(taken));
      if (!stamp) {
        ++refused;
        continue;
      }
      ++used;
      worst_off = std::max(worst_off, std::abs(*stamp - taken));
    }
  }
};

TimeNs right(TimeNs taken) { return taken; }

TEST(ScanClock, LeavesStampsAloneThatCanBeRight) {
  Scanner s;
  const auto jitter = [](TimeNs taken) { return kLag + taken / kPeriod % 7 * 10 * kMillisecond; };
  s.run(kPeriod, 10 * kSecond, right, jitter);
  EXPECT_EQ(s.refused, 0);
  EXPECT_EQ(s.worst_off, 0);
}

TEST(ScanClock, OneThatWasSetBackOrAheadIsCorrectedFromTheSecondScanOnUntilItIsRightAgain) {
  for (const TimeNs off : {-110 * kMillisecond, -250 * kMillisecond, 250 * kMillisecond, -3600 * kSecond}) {
    SCOPED_TRACE(off);
    Scanner s;
    s.run(kPeriod, 5 * kSecond, right);
    s.run(5 * kSecond + kPeriod, 15 * kSecond, [off](TimeNs taken) { return taken + off; });
    EXPECT_EQ(s.refused, 1);
    EXPECT_EQ(s.clock.correction(), -off);
    s.run(15 * kSecond + kPeriod, 20 * kSecond, right);
    EXPECT_EQ(s.refused, 2);
    EXPECT_EQ(s.clock.correction(), 0);
    EXPECT_EQ(s.worst_off, 0);
  }
}

TEST(ScanClock, ThatWasSetIsCorrectedToWithinTheJitterOfItsScans) {
  Scanner s;
  const auto jitter = [](TimeNs taken) { return kLag + taken / kPeriod % 3 * 5 * kMillisecond; };
  s.run(kPeriod, 5 * kSecond, right, jitter);
  s.run(
      5 * kSecond + kPeriod, 15 * kSecond, [](TimeNs taken) { return taken - kSecond; }, jitter);
  EXPECT_EQ(s.refused, 1);
  EXPECT_LE(s.worst_off, 10 * kMillisecond);
  s.run(15 * kSecond + kPeriod, 20 * kSecond, right, jitter);
  EXPECT_EQ(s.clock.correction(), 0);
}

TEST(ScanClock, AStrayOfThePastOrTheFutureIsNotUsedAndChangesNothing) {
  for (const TimeNs off : {-250 * kMillisecond, kSecond}) {
    Scanner s;
    s.run(kPeriod, 5 * kSecond, right);
    EXPECT_FALSE(s.clock.taken_at(5 * kSecond + off, 5 * kSecond + kLag + 1));
    s.run(5 * kSecond + kPeriod, 10 * kSecond, right);
    EXPECT_EQ(s.refused, 0);
    EXPECT_EQ(s.worst_off, 0);
  }
}

TEST(ScanClock, ScansThatSayAnotherTimeEachAreNotUsed) {
  Scanner s;
  s.run(kPeriod, 5 * kSecond, right);
  s.run(5 * kSecond + kPeriod, 10 * kSecond, [](TimeNs taken) { return 10 * kSecond - taken; });
  EXPECT_EQ(s.used, 50);
  EXPECT_EQ(s.clock.correction(), 0);
}

TEST(ScanClock, ThatIsAheadFromTheFirstScanOnSaysNothing) {
  Scanner s;
  s.run(kPeriod, kSecond, [](TimeNs taken) { return taken + kSecond; });
  EXPECT_EQ(s.used, 0);
  s.run(kSecond + kPeriod, 2 * kSecond, right);
  EXPECT_EQ(s.used, 10);
}

}  // namespace
}  // namespace karst::core
