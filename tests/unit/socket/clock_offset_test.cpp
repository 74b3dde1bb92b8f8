#include "plugins/socket/clock_offset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace karst::socket {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::TimeNs;

/// Two clocks and a link between them, with known truth.
struct TwoClocks {
  TimeNs ahead;      // of the vehicle's clock at time 0
  double drift = 0;  // of the vehicle's clock
  std::mt19937_64 random{7};

  TimeNs vehicle(TimeNs core) const {
    return core + ahead + static_cast<TimeNs>(std::llround(drift * static_cast<double>(core)));
  }
  /// Delays are exponential: most round trips are quick, some are slow, and mostly one way.
  RoundTrip trip(TimeNs sent, double mean_delay_s) {
    std::exponential_distribution<double> delay(1 / mean_delay_s);
    const TimeNs there = sent + core::from_seconds(2e-4 + delay(random));
    const TimeNs left = there + 50'000;
    return {sent, left + core::from_seconds(2e-4 + delay(random)), vehicle(there), vehicle(left)};
  }
};

TEST(ClockOffset, IsWithinItsBoundForClocksASecondApartThatDrift) {
  for (const TimeNs ahead : {kSecond, -kSecond, TimeNs{0}, 100 * kSecond})
    for (const double drift : {0.0, 15e-6, -15e-6}) {
      TwoClocks clocks{ahead, drift};
      ClockOffset offset;
      for (TimeNs t = 0; t < 60 * kSecond; t += 100 * kMillisecond) {
        const RoundTrip trip = clocks.trip(t, 5e-3);
        offset.add(trip);
        const TimeNs now = trip.answered;
        const TimeNs error = std::abs(offset.offset(now) - (clocks.vehicle(now) - now));
        if (t > 2 * kSecond) {
          // While it moves slowly it may be behind, by no more than two bounds can be apart.
          EXPECT_LE(error, 3 * offset.error_bound(now) + 10'000) << ahead << ' ' << drift << ' ' << t;
        }
      }
    }
}

TEST(ClockOffset, KeepsTheOrderOfStamps) {
  TwoClocks clocks{kSecond, 1e-4};
  ClockOffset offset;
  TimeNs last = 0;
  for (TimeNs t = 0; t < 20 * kSecond; t += 5 * kMillisecond) {
    if (t % (100 * kMillisecond) == 0) offset.add(clocks.trip(t, 10e-3));
    const TimeNs stamp = clocks.vehicle(t) - offset.offset(t);
    if (t > 2 * kSecond) {
      EXPECT_GT(stamp, last) << t;
    }
    last = stamp;
  }
}

TEST(ClockOffset, FollowsAClockThatWasSet) {
  TwoClocks clocks{0};
  ClockOffset offset;
  for (TimeNs t = 0; t < 5 * kSecond; t += 100 * kMillisecond) offset.add(clocks.trip(t, 1e-3));
  clocks.ahead = 3 * kSecond;
  for (TimeNs t = 5 * kSecond; t < 7 * kSecond; t += 100 * kMillisecond) {
    offset.add(clocks.trip(t, 1e-3));
    offset.offset(t);
  }
  EXPECT_NEAR(core::seconds(offset.offset(7 * kSecond)), 3, 2e-3);
}

TEST(ClockOffset, IgnoresRoundTripsThatCannotBe) {
  ClockOffset offset;
  offset.add({10, 5, 0, 0});
  offset.add({0, 10, 20, 15});
  offset.add({0, 10, 0, 100});
  EXPECT_FALSE(offset.known());
}

/// Of eight round trips, seven are slow in one direction: the quick one alone tells the offset.
TEST(ClockOffset, BelievesTheQuickestRoundTrip) {
  ClockOffset offset;
  for (int i = 0; i < 8; ++i) {
    const TimeNs sent = i * 100 * kMillisecond, slow = i == 3 ? 0 : 40 * kMillisecond;
    offset.add({sent, sent + slow + kMillisecond, sent + slow + kMillisecond / 2 + kSecond,
                sent + slow + kMillisecond / 2 + kSecond});
  }
  EXPECT_EQ(offset.offset(kSecond), kSecond);
}

TEST(ClockOffset, ForgetsWhatWasBeforeAClockWasSet) {
  ClockOffset offset;
  for (int i = 0; i < 20; ++i) offset.add({i * kSecond, i * kSecond + 10, i * kSecond, i * kSecond});
  EXPECT_EQ(offset.offset(20 * kSecond), -5);
  offset.forget();
  EXPECT_FALSE(offset.known());
  // The core's clock was set back by 10 s: slow answers are enough.
  for (int i = 0; i < 8; ++i) {
    const TimeNs sent = 10 * kSecond + i * kMillisecond;
    offset.add({sent, sent + 4000, sent + 10 * kSecond + 2000, sent + 10 * kSecond + 2000});
  }
  EXPECT_EQ(offset.offset(11 * kSecond), 10 * kSecond);
}

/// Without being told: the vehicle set its clock. What it measured is not taken by the old offset.
TEST(ClockOffset, FollowsAtOnceIfTwoAnswersCannotBothBeTrue) {
  ClockOffset offset;
  for (int i = 0; i < 8; ++i) offset.add({i * kSecond, i * kSecond + 10, i * kSecond, i * kSecond});
  for (int i = 8; i < 16; ++i) {
    EXPECT_NE(offset.known(), i > 8);
    offset.add({i * kSecond, i * kSecond + 40 * kMillisecond, (i - 5) * kSecond, (i - 5) * kSecond});
  }
  EXPECT_EQ(offset.offset(17 * kSecond), -5 * kSecond - 20 * kMillisecond);
}

TEST(ClockOffset, IgnoresTimesNearTheEndsOf64Bits) {
  const TimeNs least = std::numeric_limits<TimeNs>::min(), most = std::numeric_limits<TimeNs>::max();
  const TimeNs times[] = {least, least + 1, -(TimeNs{1} << 61), TimeNs{1} << 61, most - 1, most};
  ClockOffset offset;
  for (const TimeNs a : times)
    for (const TimeNs b : times) {
      offset.add({0, 10, a, b});
      offset.add({a, b, 0, 0});
      offset.add({0, 10, 0, b});
    }
  EXPECT_FALSE(offset.known());
  for (const TimeNs far : {(TimeNs{1} << 61) - 1, -(TimeNs{1} << 61) + 1}) {
    for (int i = 0; i < 8; ++i) offset.add({0, 10, far, far});
    ASSERT_TRUE(offset.known());
    EXPECT_EQ(offset.offset(40), far - 5);
  }
}

}  // namespace
}  // namespace karst::socket
