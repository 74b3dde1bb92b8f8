// The curve's sums against areas drawn by hand.
#include "sdk/evaluation/metrics/coverage_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using test::TemporaryDirectory;

/// Takes off at 10 s; 20 m^3 are seen from the ground, 40 from 15 s on, 80 from 30 s until the record ends.
RunRecord stepwise_run(const TemporaryDirectory& dir) {
  dir.write("events.jsonl",
            "{\"t\": 0, \"kind\": \"phase\", \"phase\": \"standby\"}\n"
            "{\"t\": 10, \"kind\": \"phase\", \"phase\": \"takeoff\"}\n");
  dir.write(
      "telemetry.csv",
      "t_s,phase,explored_m3\n2,standby,20\n15,explore,40\n20,explore,nan\n30,explore,80\n40,home,80\n");
  return read_run(dir.path());
}

TEST(CoverageCurve, GrowsInProportionToTheVolumeFromTakeOffOn) {
  TemporaryDirectory dir;
  const auto curve = coverage_curve(stepwise_run(dir), 0.6);
  ASSERT_EQ(curve.size(), 4u);
  const double expected[4][3] = {{0, 20, 0.15}, {5, 40, 0.3}, {20, 80, 0.6}, {30, 80, 0.6}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(curve[i].time_s, expected[i][0]);
    EXPECT_EQ(curve[i].explored_m3, expected[i][1]);
    EXPECT_NEAR(curve[i].coverage, expected[i][2], 1e-12);
  }
}

TEST(CoverageCurve, BeginsWithNothingIfNothingWasSeenBeforeTakeOff) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", "{\"t\": 1, \"kind\": \"phase\", \"phase\": \"takeoff\"}\n");
  dir.write("telemetry.csv", "t_s,phase,explored_m3\n3,explore,10\n");
  const auto curve = coverage_curve(read_run(dir.path()), 0.5);
  ASSERT_EQ(curve.size(), 2u);
  EXPECT_EQ(curve[0].time_s, 0);
  EXPECT_EQ(curve[0].coverage, 0);
  EXPECT_EQ(curve[1].time_s, 2);
}

TEST(CoverageCurve, ItsMeanIsTheAreaBelowItOverTheHorizon) {
  TemporaryDirectory dir;
  const auto curve = coverage_curve(stepwise_run(dir), 0.6);
  // 0.15 for 5 s, 0.3 for 15 s, 0.6 from 20 s on; the last stands on after the record's end at 30 s.
  EXPECT_NEAR(*mean_coverage(curve, 20), (0.15 * 5 + 0.3 * 15) / 20, 1e-12);
  EXPECT_NEAR(*mean_coverage(curve, 100), (0.15 * 5 + 0.3 * 15 + 0.6 * 80) / 100, 1e-12);
  EXPECT_NEAR(*mean_coverage(curve, 3), 0.15, 1e-12);
  EXPECT_FALSE(mean_coverage(curve, 0));
  EXPECT_FALSE(mean_coverage({}, 100));
}

TEST(CoverageCurve, NeverSaysThatMoreWasCoveredThanThereIs) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", "{\"t\": 1, \"kind\": \"phase\", \"phase\": \"takeoff\"}\n");
  dir.write("telemetry.csv", "t_s,phase,explored_m3\n2,takeoff,0\n10,explore,101\n20,home,100\n");
  const auto curve = coverage_curve(read_run(dir.path()), 0.998);
  ASSERT_FALSE(curve.empty());
  double most = 0;
  for (const CoveragePoint& p : curve) most = std::max(most, p.coverage);
  EXPECT_EQ(most, 1.0);
  EXPECT_NEAR(curve.back().coverage, 0.998, 1e-12);
}

TEST(CoverageCurve, IsReadAtAnyTime) {
  TemporaryDirectory dir;
  const auto curve = coverage_curve(stepwise_run(dir), 0.6);
  for (const CoveragePoint& p : curve) {
    EXPECT_EQ(coverage_at(curve, p.time_s), p.coverage);
    EXPECT_EQ(coverage_at(curve, p.time_s + 1e-6), p.coverage);
  }
  EXPECT_EQ(coverage_at(curve, -1), 0);
  EXPECT_EQ(coverage_at(curve, 1e9), 0.6);
  EXPECT_FALSE(coverage_at({}, 10));
}

TEST(CoverageCurve, WithoutACoverageHasAVolumeOnly) {
  TemporaryDirectory dir;
  const auto curve = coverage_curve(stepwise_run(dir), std::nullopt);
  ASSERT_EQ(curve.size(), 4u);
  EXPECT_EQ(curve[2].explored_m3, 80);
  EXPECT_TRUE(std::isnan(curve[2].coverage));
  EXPECT_FALSE(mean_coverage(curve, 100));
  EXPECT_FALSE(time_of_coverage(curve, 0.1));
}

TEST(CoverageCurve, OfARunWithoutTelemetryIsEmpty) {
  TemporaryDirectory dir;
  EXPECT_TRUE(coverage_curve(read_run(dir.path()), 0.5).empty());
}

TEST(Horizon, IsTheShorterOfTimeLimitAndBattery) {
  TemporaryDirectory dir;
  EXPECT_FALSE(horizon_s(read_run(dir.path())));
  dir.write("mission.info",
            "mission\n{\nmax_flight_time \"300 s\"\n}\nsimulator\n{\nbattery_minutes \"6.5 min\"\n}\n");
  EXPECT_EQ(horizon_s(read_run(dir.path())), 300);
  dir.write("mission.info",
            "mission\n{\nmax_flight_time \"3600 s\"\n}\nsimulator\n{\nbattery_minutes \"6.5 min\"\n}\n");
  EXPECT_EQ(horizon_s(read_run(dir.path())), 390);
  dir.write("mission.info", "mission\n{\nmax_flight_time \"3600 s\"\n}\n");
  EXPECT_EQ(horizon_s(read_run(dir.path())), 3600);
}

}  // namespace
}  // namespace karst::evaluation
