#include "sdk/evaluation/metrics/speed_limit_times.h"

#include <gtest/gtest.h>

namespace karst::evaluation {
namespace {

using core::SpeedLimit;

/// 10 s at 3 m/s along x, from 2 s on while exploring.
RunRecord run() {
  RunRecord r;
  for (int i = 0; i <= 100; ++i) {
    r.telemetry.numbers["t_s"].push_back(0.1 * i);
    r.telemetry.numbers["ref_x"].push_back(0.3 * i);
    r.telemetry.numbers["ref_y"].push_back(0);
    r.telemetry.numbers["ref_z"].push_back(1);
  }
  r.telemetry.rows = 101;
  r.phases = {{"takeoff", 0, 2}, {"explore", 2, 10}};
  return r;
}

nlohmann::json limit(double t_s, const char* by) {
  return {{"t", t_s}, {"kind", "speed_limit"}, {"by", by}, {"speed", 3}};
}

TEST(SpeedLimitTimes, EachLimitLastsUntilTheNext) {
  RunRecord r = run();
  r.events = {limit(1, "speeding_up"), limit(4, "sight"), limit(7, "allowed")};
  const SpeedLimitTimes times = speed_limit_times(r);
  EXPECT_NEAR(times[SpeedLimit::speeding_up].time_s, 2, 0.15);
  EXPECT_NEAR(times[SpeedLimit::sight].time_s, 3, 0.15);
  EXPECT_NEAR(times[SpeedLimit::sight].path_m, 9, 0.5);
  EXPECT_NEAR(times[SpeedLimit::allowed].time_s, 3, 0.15);
  EXPECT_NEAR(times.total_s(), 8, 0.15);
  EXPECT_NEAR(speed_limit_times(r, 5).total_s(), 3, 0.15);
}

TEST(SpeedLimitTimes, ARunThatDoesNotTellHasNone) { EXPECT_EQ(speed_limit_times(run()).total_s(), 0); }

TEST(SpeedLimitTimes, EveryLimitHasWords) {
  for (const auto& [by, name] : names_of(SpeedLimit{})) EXPECT_STRNE(words_for(by), "") << name;
}

}  // namespace
}  // namespace karst::evaluation
