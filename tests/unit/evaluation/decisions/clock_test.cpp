// Times as people write them.
#include "sdk/evaluation/decisions/clock.h"

#include <gtest/gtest.h>

namespace karst::evaluation {
namespace {

TEST(Clock, ReadsSecondsAndMinutes) {
  EXPECT_EQ(seconds_of_clock("94"), 94);
  EXPECT_EQ(seconds_of_clock("94.5"), 94.5);
  EXPECT_EQ(seconds_of_clock("0"), 0);
  EXPECT_EQ(seconds_of_clock("1:34"), 94);
  EXPECT_EQ(seconds_of_clock("1:34.5"), 94.5);
  EXPECT_EQ(seconds_of_clock("61:05"), 3665);
}

TEST(Clock, ReadsUnitsOfTime) {
  EXPECT_EQ(seconds_of_clock("10 s"), 10);
  EXPECT_EQ(seconds_of_clock("8.7s"), 8.7);
  EXPECT_EQ(seconds_of_clock("1.5 min"), 90);
  EXPECT_EQ(seconds_of_clock("2h"), 7200);
  EXPECT_EQ(seconds_of_clock("1e2 s"), 100);
}

TEST(Clock, RefusesWhatIsNoTime) {
  for (const char* text :
       {"",       ":",    "1:",  ":34", "1:60",   "-1",   "-1:10",   "1:-10",  "+5",    "nan", "inf",  "soon",
        "1:34 s", "10 m", "10 ", "s",   "10 s s", "-1 s", "1e400 s", "1.5:10", "1:2:3", " 94", "1e999"})
    EXPECT_FALSE(seconds_of_clock(text)) << text;
}

TEST(Clock, WritesHundredths) {
  EXPECT_EQ(clock_text(0), "0:00.00");
  EXPECT_EQ(clock_text(94.3), "1:34.30");
  EXPECT_EQ(clock_text(59.999), "1:00.00");
  EXPECT_EQ(clock_text(3665.25), "61:05.25");
}

TEST(Clock, ReadsWhatItWrites) {
  for (int hundredths = 0; hundredths < 20000; hundredths += 37)
    EXPECT_NEAR(seconds_of_clock(clock_text(hundredths / 100.0)).value_or(-1), hundredths / 100.0, 1e-9);
}

}  // namespace
}  // namespace karst::evaluation
