#include "plugins/lidar_drivers/packet/sensor_clock.h"

#include <gtest/gtest.h>

#include "core_stack/common/random.h"
#include "plugins/lidar_drivers/packet/sequence.h"

namespace {

using namespace karst;
using core::kMillisecond;
using core::kSecond;
using core::TimeNs;
using lidar::SensorClock;
using lidar::Sequence;

TEST(SensorClock, SaysNothingBeforeTheFirstPacket) { EXPECT_FALSE(SensorClock().at(5).has_value()); }

// Packets are polled every 10 ms, wait 0.1 ms on the line and up to 8 ms more, and the sensor's clock gains
// 50 ppm.
TEST(SensorClock, FindsTheOffsetUnderDelaysAndDrift) {
  core::Random random(3);
  SensorClock clock;
  const std::int64_t ahead = 1'234'567'890'123;
  const auto sensor_at = [&](TimeNs t) { return t + ahead + t / 20000; };
  TimeNs worst = 0;
  for (TimeNs poll = 0; poll < 60 * kSecond; poll += 10 * kMillisecond)
    for (int i = 0; i < 6; ++i) {
      const TimeNs sent =
          poll - static_cast<TimeNs>(random.uniform(0.1, 10) * kMillisecond) -
          (random.uniform() < 0.3 ? static_cast<TimeNs>(random.uniform(0, 8) * kMillisecond) : 0);
      clock.observe(sensor_at(sent), poll);
      const TimeNs said = *clock.at(sensor_at(sent));
      EXPECT_LE(said, poll);
      if (poll > kSecond) worst = std::max(worst, std::abs(said - sent));
    }
  EXPECT_LT(worst, kMillisecond);
}

TEST(SensorClock, OneWrongStampChangesNothingAndAClockThatWasSetIsFollowed) {
  SensorClock clock;
  TimeNs now = 0;
  for (int i = 0; i < 100; ++i, now += kMillisecond) clock.observe(now + 7 * kSecond, now);
  for (const std::int64_t lie : {std::int64_t{0}, std::int64_t{1} << 61, now + 9 * kSecond}) {
    clock.observe(lie, now);
    EXPECT_EQ(clock.at(7 * kSecond), 0);
  }
  for (const std::int64_t ahead : {-3600 * kSecond, 5000 * kSecond}) {
    for (int i = 0; i < 50; ++i, now += kMillisecond) clock.observe(now + ahead, now);
    EXPECT_EQ(clock.at(ahead + now), now);
  }
}

TEST(SensorClock, ASynchronizedStampIsAsOldAsTheHostsClockSays) {
  // The host says 100 s, the sensor stamped 136.9 s on a clock that is 37 s ahead: 0.1 s ago.
  EXPECT_EQ(lidar::synchronized_at(136'900 * kMillisecond, 37 * kSecond, 100 * kSecond, 20 * kSecond),
            19'900 * kMillisecond);
}

TEST(Sequence, CountsWhatIsMissingAndForgivesWhatWasOvertaken) {
  Sequence s;
  for (const int n : {65534, 65535, 0, 2, 3})
    EXPECT_EQ(s.take(static_cast<std::uint16_t>(n)), Sequence::Arrival::fresh);
  EXPECT_EQ(s.lost(), 1u);
  EXPECT_EQ(s.take(1), Sequence::Arrival::fresh);
  EXPECT_EQ(s.lost(), 0u);
  EXPECT_EQ(s.take(1), Sequence::Arrival::duplicate);
  EXPECT_EQ(s.take(3), Sequence::Arrival::duplicate);
  EXPECT_EQ(s.take(100), Sequence::Arrival::fresh);
  EXPECT_EQ(s.lost(), 96u);
}

// Documentation says that the counter begins at 0 with each frame; firmware lets it run.
TEST(Sequence, ACounterThatBeginsAnewLosesNothing) {
  Sequence s;
  for (int frame = 0; frame < 3; ++frame)
    for (std::uint16_t n = 0; n < 209; ++n) s.take(n);
  EXPECT_EQ(s.lost(), 0u);
}

// Independent reference: a set of the numbers that came.
TEST(Sequence, LossesAreThoseOfTheSetOfNumbers) {
  core::Random random(8);
  Sequence s;
  std::vector<int> sent;
  for (int n = 0; n < 70000; ++n)
    if (n == 0 || n == 69999 || random.uniform() < 0.98) sent.push_back(n);
  for (std::size_t i = 2; i + 2 < sent.size(); ++i)
    if (random.uniform() < 0.05) std::swap(sent[i], sent[i + 1]);
  for (const int n : sent) EXPECT_EQ(s.take(static_cast<std::uint16_t>(n)), Sequence::Arrival::fresh);
  EXPECT_EQ(s.lost(), 70000 - sent.size());
}

}  // namespace
