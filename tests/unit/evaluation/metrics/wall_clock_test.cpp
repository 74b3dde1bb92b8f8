#include "sdk/evaluation/metrics/wall_clock.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using test::TemporaryDirectory;

TEST(WallClock, IsReadFromTimingAndDecisions) {
  TemporaryDirectory dir;
  dir.write("timing.json",
            R"({"wall_s": 20.5, "simulated_s": 300, "simulated_s_per_wall_s": 14.6, "jobs": {}})");
  std::string rows = "t_s,decide_ms,plan_ms\n";  // deciding takes 1 .. 200 ms, planning is known of two only
  for (int i = 1; i <= 200; ++i)
    rows += std::to_string(i) + "," + std::to_string(i) + "," + (i == 7 ? "4" : i == 8 ? "6" : "nan") + "\n";
  dir.write("decisions.csv", rows);
  std::vector<std::string> problems;
  const WallClock w = read_wall_clock(dir.path(), problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(w.wall_s, 20.5);
  EXPECT_EQ(w.simulated_s, 300);
  EXPECT_EQ(w.simulated_s_per_wall_s, 14.6);
  EXPECT_EQ(w.decide_mean_ms, 100.5);
  EXPECT_EQ(w.decide_p99_ms, 198);
  EXPECT_EQ(w.decide_max_ms, 200);
  EXPECT_EQ(w.plan_mean_ms, 5);
  EXPECT_EQ(w.plan_p99_ms, 6);
  EXPECT_EQ(w.plan_max_ms, 6);
}

TEST(WallClock, IsUnknownWhereNothingWasWritten) {
  TemporaryDirectory dir;
  std::vector<std::string> problems;
  const WallClock w = read_wall_clock(dir.path(), problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_TRUE(std::isnan(w.wall_s));
  EXPECT_TRUE(std::isnan(w.decide_mean_ms));
  EXPECT_TRUE(std::isnan(w.plan_max_ms));
}

TEST(WallClock, SaysWhatIsDamaged) {
  TemporaryDirectory dir;
  for (const char* text : {"{\"wall_s\": 2", "[1, 2]", "", "\xff\xfe"}) {
    dir.write("timing.json", text);
    std::vector<std::string> problems;
    EXPECT_TRUE(std::isnan(read_wall_clock(dir.path(), problems).wall_s));
    ASSERT_EQ(problems.size(), 1u) << text;
    EXPECT_NE(problems.front().find("timing.json"), std::string::npos);
  }
  dir.write("timing.json", R"({"wall_s": "long"})");
  std::vector<std::string> problems;
  EXPECT_TRUE(std::isnan(read_wall_clock(dir.path(), problems).wall_s));
}

}  // namespace
}  // namespace karst::evaluation
