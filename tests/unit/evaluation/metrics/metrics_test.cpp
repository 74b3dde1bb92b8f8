// Each figure against its closed form on a small hand-made run.
#include "sdk/evaluation/metrics/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using core::Vec3;
using nlohmann::ordered_json;
using test::TemporaryDirectory;

constexpr const char* kPhases =
    R"({"t": 0.0, "kind": "phase", "phase": "standby"}
{"t": 10.0, "kind": "phase", "phase": "takeoff"}
{"t": 12.0, "kind": "phase", "phase": "explore"}
{"t": 32.0, "kind": "phase", "phase": "home"}
{"t": 42.0, "kind": "phase", "phase": "land"}
{"t": 44.0, "kind": "phase", "phase": "done"}
)";
constexpr const char* kLanded = R"({"t": 44.0, "kind": "outcome", "outcome": "landed", "reason": "explored"})"
                                "\n";

ordered_json figures(const TemporaryDirectory& dir, const Truth& truth = {}) {
  return evaluate_run(dir.path(), truth);
}

TEST(Metrics, HaveEveryNameInOrderAndNullWhereNothingIsKnown) {
  TemporaryDirectory dir;
  const ordered_json m = figures(dir);
  const std::vector<std::string> names{"schema",
                                       "policy",
                                       "cave",
                                       "seed",
                                       "outcome",
                                       "reason",
                                       "completed",
                                       "contacts",
                                       "flight_time_s",
                                       "exploration_time_s",
                                       "path_length_m",
                                       "mean_speed_mps",
                                       "exploring_speed_mps",
                                       "standing_share",
                                       "longest_stall_s",
                                       "energy_wh",
                                       "explored_volume_m3",
                                       "reachable_volume_m3",
                                       "coverage",
                                       "horizon_s",
                                       "coverage_auc",
                                       "coverage_at_25",
                                       "coverage_at_50",
                                       "coverage_at_75",
                                       "t50_s",
                                       "t90_s",
                                       "t95_s",
                                       "restricted_t50_s",
                                       "restricted_t90_s",
                                       "restricted_t95_s",
                                       "surface_seen",
                                       "surface_imaged",
                                       "depth_m",
                                       "vertical_reach_m",
                                       "min_clearance_m",
                                       "landing_error_m",
                                       "battery_left",
                                       "map_error_mean_m",
                                       "map_error_std_m",
                                       "drift_percent",
                                       "heading_error_rad",
                                       "tracking_rms_m",
                                       "goals_accepted",
                                       "goals_rejected",
                                       "overruns",
                                       "objects_placed",
                                       "objects_seen",
                                       "objects_found",
                                       "objects_reported",
                                       "objects_reported_share",
                                       "object_report_time_s",
                                       "object_error_m",
                                       "objects_false",
                                       "data_at_base_share",
                                       "robots_landed",
                                       "robots_connected",
                                       "exploration_time_1_s",
                                       "exploration_time_2_s",
                                       "exploration_time_3_s",
                                       "exploration_time_4_s",
                                       "exploration_time_5_s",
                                       "volume_per_wh_m3"};
  std::vector<std::string> found;
  for (const auto& [key, value] : m.items()) {
    found.push_back(key);
    const bool always = key == "schema" || key == "outcome" || key == "reason";
    EXPECT_NE(always, value.is_null()) << key;
  }
  EXPECT_EQ(found, names);
  EXPECT_EQ(m["outcome"], "aborted");
}

TEST(Metrics, AreRefusedForWhatIsNoRunDirectory) {
  EXPECT_THROW(evaluate_run("/nowhere/at/all", {}), core::InputError);
}

TEST(Metrics, NameTheRunFromItsSettings) {
  TemporaryDirectory dir;
  dir.write("mission.info",
            "seed 12\ncave\n{\nfile \"/some/where/bull_rock.info\"\n}\npolicy\n{\nname lateral\n}\n");
  const ordered_json m = figures(dir);
  EXPECT_EQ(m["policy"], "lateral");
  EXPECT_EQ(m["cave"], "bull_rock");
  EXPECT_EQ(m["seed"], 12);
}

TEST(Metrics, TimesComeFromThePhases) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);
  const ordered_json m = figures(dir);
  EXPECT_EQ(m["flight_time_s"], 34.0);
  EXPECT_EQ(m["exploration_time_s"], 20.0);
  EXPECT_EQ(m["outcome"], "landed");
  EXPECT_EQ(m["reason"], "explored");
}

TEST(Metrics, SeveralExplorationsAreAddedUp) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", R"({"t": 0, "kind": "phase", "phase": "explore"}
{"t": 5, "kind": "phase", "phase": "home"}
{"t": 6, "kind": "phase", "phase": "explore"}
{"t": 8.5, "kind": "phase", "phase": "land"}
{"t": 9, "kind": "phase", "phase": "done"}
)");
  EXPECT_EQ(figures(dir)["exploration_time_s"], 7.5);
}

TEST(Metrics, PathIsTheTruthsLengthInFlightAndSpeedItsMean) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);
  std::string truth, estimate;
  for (int t = 0; t <= 60; ++t) {  // 2 m/s east from t = 10 to 44
    const double x = 2.0 * std::clamp(t - 10, 0, 34);
    truth += std::to_string(t) + " " + std::to_string(x) + " 0 1 0 0 0 1\n";
    estimate += std::to_string(t) + " " + std::to_string(9 * x) + " 0 1 0 0 0 1\n";
  }
  dir.write("trajectory.tum", estimate);
  EXPECT_EQ(figures(dir)["path_length_m"], 9 * 68.0);  // without truth, the estimate's
  dir.write("ground_truth.tum", truth);
  EXPECT_EQ(figures(dir)["path_length_m"], 68.0);
  EXPECT_EQ(figures(dir)["mean_speed_mps"], 2.0);
}

TEST(Metrics, StandingIsTheShareOfExploringTimeBelowTwentyCentimetresASecond) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);
  std::string truth = "time_s,clearance_m,speed_mps\n";  // stands outside of exploring, too
  for (int i = 0; i <= 440; ++i) {
    const double t = i * 0.1;
    const bool stands = t < 12.05 || t > 32.05 || (t > 15.05 && t < 20.05);
    truth += std::to_string(t) + ",1," + (stands ? "0.19" : "0.21") + "\n";
  }
  dir.write("truth.csv", truth);
  EXPECT_NEAR(figures(dir)["standing_share"].get<double>(), 5.0 / 20.0, 0.006);  // one row is 0.005
  EXPECT_NEAR(figures(dir)["exploring_speed_mps"].get<double>(), (5 * 0.19 + 15 * 0.21) / 20, 0.001);
}

TEST(Metrics, StandingFallsBackToTheEstimatedVelocity) {
  TemporaryDirectory dir;
  dir.write(
      "telemetry.csv",
      "t_s,phase,vx,vy,vz\n0,explore,0,0,0\n1,explore,0.1,0.1,0.1\n2,explore,0.1,0.1,0.2\n3,explore,1,0,0\n"
      "4,explore,0,0,0\n5,home,0,0,0\n");
  // Of the five intervals those end at standing which end at 1, 4 and 5 s; at 2 s it moves at 0.24 m/s.
  EXPECT_EQ(figures(dir)["standing_share"], 0.6);
}

TEST(Metrics, TheLongestStallIsTheLongestTimeWithinHalfAMetre) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);  // explores from 12 s, goes home at 32 s
  std::string truth;
  for (int i = 0; i <= 440; ++i) {
    const double t = i * 0.1;
    // 1 m/s, but from 15 s on it circles within 0.2 m for 4 s; stands before exploring as well.
    const double x = t < 12 ? 0 : t < 15 ? t - 12 : t < 19 ? 3 + 0.1 * std::sin(9 * t) : t - 16;
    truth += std::to_string(t) + " " + std::to_string(x) + " 0 0 0 0 0 1\n";
  }
  dir.write("ground_truth.tum", truth);
  // The clock began at most half a metre before the place, and runs on until half a metre behind it.
  EXPECT_NEAR(figures(dir)["longest_stall_s"].get<double>(), 4.5, 0.55);
}

TEST(Metrics, LeastClearanceIgnoresTakeOffAndLanding) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);
  dir.write(
      "truth.csv",
      "time_s,clearance_m,speed_mps\n0,0,0\n11,0.1,1\n13,2.5,1\n20,0.8,1\n35,0.7,1\n36,nan,1\n43,0.05,1\n");
  EXPECT_EQ(figures(dir)["min_clearance_m"], 0.7);
}

TEST(Metrics, LandingErrorIsHorizontalAndOnlyOfALanding) {
  TemporaryDirectory dir;
  dir.write("ground_truth.tum", "0 1 1 0 0 0 0 1\n44 4 5 7 0 0 0 1\n");
  dir.write("events.jsonl", std::string(kPhases) + kLanded);
  EXPECT_EQ(figures(dir)["landing_error_m"], 5.0);
  dir.write("events.jsonl",
            std::string(kPhases) + R"({"t":44,"kind":"outcome","outcome":"stuck","reason":""})" + "\n");
  EXPECT_TRUE(figures(dir)["landing_error_m"].is_null());
}

TEST(Metrics, ContactsAreTheSimulatorsOrAtLeastTheOneThatEndedTheFlight) {
  TemporaryDirectory dir;
  dir.write("events.jsonl",
            std::string(kPhases) + R"({"t":44,"kind":"outcome","outcome":"contact","reason":"rock"})" + "\n");
  EXPECT_EQ(figures(dir)["contacts"], 1);
  dir.write("truth_events.jsonl",
            "{\"time_s\": 1, \"event\": \"start\"}\n{\"time_s\": 2, \"event\": \"contact\"}\n{\"time_s\": 3, "
            "\"event\": \"contact\"}\n");
  EXPECT_EQ(figures(dir)["contacts"], 2);
}

TEST(Metrics, DriftIsTheLastErrorPerPathAndHeadingErrorItsRootMeanSquare) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);
  std::string truth, estimate;
  for (int t = 10; t <= 44; ++t) {  // headings differ by 0.1 half of the time, across the wrap at pi
    const auto line = [&](double x, double y, double heading) {
      return std::to_string(t) + " " + std::to_string(x) + " " + std::to_string(y) + " 0 0 0 " +
             std::to_string(std::sin(heading / 2)) + " " + std::to_string(std::cos(heading / 2)) + "\n";
    };
    truth += line(t - 10.0, 0, std::numbers::pi - 0.05);
    estimate +=
        line(t - 10.0, 0.02 * (t - 10.0), t % 2 == 0 ? std::numbers::pi - 0.05 : std::numbers::pi + 0.05);
  }
  dir.write("ground_truth.tum", truth);
  dir.write("trajectory.tum", estimate);
  const ordered_json m = figures(dir);
  EXPECT_NEAR(m["drift_percent"].get<double>(), 2.0, 1e-9);
  EXPECT_NEAR(m["heading_error_rad"].get<double>(), 0.1 * std::sqrt(17.0 / 35.0), 1e-4);
}

TEST(Metrics, TrackingIsTheEstimateAgainstReferenceInFlight) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);
  dir.write("telemetry.csv",
            "t_s,phase,x,y,z,ref_x,ref_y,ref_z\n5,standby,0,0,0,0,0,99\n12,explore,12,0,0,12,0,3\n"
            "20.5,explore,20.5,0,1,20.5,4,1\n60,done,0,0,0,0,0,9\n");
  EXPECT_NEAR(figures(dir)["tracking_rms_m"].get<double>(), std::sqrt((9.0 + 16.0) / 2), 1e-6);
}

TEST(Metrics, GoalsAndOverrunsAreCounted) {
  TemporaryDirectory dir;
  std::string events = kPhases;
  for (const char* state :
       {"accepted", "rejected", "accepted", "reached", "rejected", "accepted", "abandoned"})
    events += std::string(R"({"t": 13, "kind": "goal", "state": ")") + state + "\"}\n";
  events += "{\"t\": 14, \"kind\": \"overrun\"}\n";
  dir.write("events.jsonl", events);
  const ordered_json m = figures(dir);
  EXPECT_EQ(m["goals_accepted"], 3);
  EXPECT_EQ(m["goals_rejected"], 2);
  EXPECT_EQ(m["overruns"], 1);
}

/// A map whose known-free cells are exactly those of a ball.
core::VoxelMap ball_map(double radius_m) {
  core::VoxelMap map{core::MapOptions{}};
  map.declare_free(Vec3(0.1, 0.1, 0.1), radius_m);
  return map;
}

TEST(Metrics, VolumeAndCoverageCountTheFinalMapsFreeCells) {
  const core::VoxelMap map = ball_map(2.0);
  std::size_t all = 0, above = 0;
  map.for_each_known([&](const core::CellKey& k, core::Cell, float) { ++all, above += k.z >= 0; });
  ASSERT_GT(all, 1000u);
  TemporaryDirectory dir;
  dir.write("telemetry.csv", "t_s,phase,explored_m3\n0,explore,10\n1,explore,20\n");
  Truth truth;
  truth.reachable_volume_m3 = 40.0;
  truth.is_reachable = [](const Vec3& p) { return p.z() > 0; };
  const ordered_json m = evaluate(read_run(dir.path()), &map, truth);
  EXPECT_NEAR(m["explored_volume_m3"].get<double>(), static_cast<double>(all) * 0.008, 1e-6);
  EXPECT_NEAR(m["coverage"].get<double>(), static_cast<double>(above) * 0.008 / 40, 1e-6);
  EXPECT_EQ(m["reachable_volume_m3"], 40.0);
}

TEST(Metrics, OfARunCutShortAreThoseOfTheTelemetrysLastVolume) {
  TemporaryDirectory dir;
  dir.write("telemetry.csv", "t_s,phase,explored_m3\n0,explore,10\n1,explore,20\n2,explore,nan\n");
  Truth truth;
  truth.reachable_volume_m3 = 40.0;
  truth.is_reachable = [](const Vec3&) { return true; };
  const ordered_json m = figures(dir, truth);
  EXPECT_EQ(m["explored_volume_m3"], 20.0);
  EXPECT_EQ(m["coverage"], 0.5);
  truth.reachable_volume_m3 = 16.0;
  EXPECT_EQ(figures(dir, truth)["coverage"], 1.0) << "never more than all of it";
  EXPECT_TRUE(figures(dir)["coverage"].is_null()) << "of an unknown cave";
}

TEST(Metrics, TimesOfCoverageAreCountedFromTakeOffAndNullIfNeverReached) {
  const core::VoxelMap map = ball_map(2.0);
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);
  std::string telemetry = "t_s,phase,explored_m3\n";  // linear from 0 at t = 12 to 100 at t = 32
  for (int t = 0; t <= 44; ++t)
    telemetry += std::to_string(t) + ",x," + std::to_string(5.0 * std::clamp(t - 12, 0, 20)) + "\n";
  dir.write("telemetry.csv", telemetry);
  Truth truth;
  truth.is_reachable = [](const Vec3&) { return true; };
  truth.reachable_volume_m3 = map.free_volume_m3() / 0.92;  // ends at 92 %
  const ordered_json m = evaluate(read_run(dir.path()), &map, truth);
  EXPECT_NEAR(m["coverage"].get<double>(), 0.92, 1e-6);
  EXPECT_EQ(m["t50_s"], 23.0 - 10.0);  // 0.92 * 11/20 is the first value over 0.5
  EXPECT_EQ(m["t90_s"], 32.0 - 10.0);
  EXPECT_TRUE(m["t95_s"].is_null());
}

TEST(Metrics, OfAReplayTellItsScansAndByHowFarLoopsCorrectedThem) {
  TemporaryDirectory dir;
  dir.write("trajectory.tum", "100 0 0 0 0 0 0 1\n101 1 0 0 0 0 0 1\n102 2 0.3 0.4 0 0 0 1\n");
  dir.write("telemetry.csv", "t_s,explored_m3\n0,1\n1,2\n2,3\n3,3\n");
  EXPECT_FALSE(figures(dir).contains("recording"));
  dir.write("mission.info", "replay { scans \"/data/flight 7.bag\" }\n");
  const ordered_json open = figures(dir);
  EXPECT_EQ(open["recording"], "flight 7.bag");
  EXPECT_EQ(open["scans"], 4);
  EXPECT_EQ(open["scans_lost"], 1);
  EXPECT_EQ(open["loops_closed"], 0);
  EXPECT_TRUE(open["loop_correction_m"].is_null());

  dir.write("trajectory_odometry.tum", "100 0 0 0 0 0 0 1\n101 1 0.1 0 0 0 0 1\n102 2 0 0 0 0 0 1\n");
  dir.write("loops.csv", "older_s,newer_s,state\n1,2,closed\n1,3,alone\n2,3,closed\n");
  dir.write("mission.info", "replay { scans /data/scans/ }\n");
  const ordered_json closed = figures(dir);
  EXPECT_EQ(closed["recording"], "scans");
  EXPECT_EQ(closed["loops_closed"], 2);
  EXPECT_NEAR(closed["loop_correction_m"].get<double>(), 0.5, 1e-9);
}

TEST(Metrics, OfWhatASurveyLacksAreThereIfTheMissionHasOne) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);  // take-off at 10 s
  const auto of = [&dir](const std::string& rows) {
    dir.write("unsurveyed.csv", "t_s,unsurveyed_m3\n" + rows);
    return figures(dir);
  };
  EXPECT_FALSE(figures(dir).contains("unsurveyed_volume_m3"));
  const ordered_json m = of("0.5,0.000\n20,49.992\n31.5,50.000\n33,48.000\n40,61.500\n");
  EXPECT_EQ(m["unsurveyed_volume_m3"], 61.5);
  EXPECT_EQ(m["time_to_unsurveyed_50_s"], 21.5) << "from take-off, and the first time";
  const ordered_json never = of("0.5,0.000\n20,49.992\n");
  EXPECT_EQ(never["unsurveyed_volume_m3"], 49.992);
  EXPECT_TRUE(never.contains("time_to_unsurveyed_50_s"));
  EXPECT_TRUE(never["time_to_unsurveyed_50_s"].is_null());
  EXPECT_EQ(of("0.5,80\n")["time_to_unsurveyed_50_s"], 0.0) << "seen from the ground";
}

TEST(Metrics, ACoverageReachedBeforeTakeOffTookNoTime) {
  const core::VoxelMap map = ball_map(2.0);
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);  // take-off at 10 s
  dir.write("telemetry.csv", "t_s,phase,explored_m3\n2,x,80\n12,x,95\n44,x,100\n");
  Truth truth;
  truth.is_reachable = [](const Vec3&) { return true; };
  truth.reachable_volume_m3 = map.free_volume_m3();
  const ordered_json m = evaluate(read_run(dir.path()), &map, truth);
  EXPECT_EQ(m["t50_s"], 0.0);
  EXPECT_EQ(m["t90_s"], 2.0);
}

TEST(Metrics, RestrictedTimesEndAtTheHorizonAndTheAreaRunsToIt) {
  const core::VoxelMap map = ball_map(2.0);
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);  // take-off at 10 s
  dir.write("telemetry.csv", "t_s,phase,explored_m3\n2,x,0\n20,x,60\n30,x,100\n44,x,100\n");
  dir.write("mission.info", "mission\n{\nmax_flight_time \"100 s\"\n}\n");
  Truth truth;
  truth.is_reachable = [](const Vec3&) { return true; };
  truth.reachable_volume_m3 = map.free_volume_m3() / 0.92;
  const ordered_json m = evaluate(read_run(dir.path()), &map, truth);
  EXPECT_EQ(m["horizon_s"], 100.0);
  EXPECT_EQ(m["restricted_t50_s"], 10.0);
  EXPECT_EQ(m["restricted_t90_s"], 20.0);
  EXPECT_TRUE(m["t95_s"].is_null());
  EXPECT_EQ(m["restricted_t95_s"], 100.0);
  EXPECT_NEAR(m["coverage_auc"].get<double>(), 0.92 * (0.6 * 10 + 1.0 * 80) / 100, 1e-6);
  dir.write("mission.info", "mission\n{\nmax_flight_time \"15 s\"\n}\n");
  const ordered_json shorter = evaluate(read_run(dir.path()), &map, truth);
  EXPECT_EQ(shorter["restricted_t90_s"], 15.0) << "reached, but after the horizon";
  EXPECT_NEAR(shorter["coverage_auc"].get<double>(), 0.92 * 0.6 * 5 / 15, 1e-6);
  EXPECT_TRUE(figures(dir)["restricted_t90_s"].is_null()) << "the cave is not known";
}

TEST(Metrics, EnergyIsWhatTheBatteryLostInFlight) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);  // flies from 10 to 44 s
  dir.write("mission.info", "simulator\n{\nhover_power \"300 W\"\nbattery_minutes \"6 min\"\n}\n");
  dir.write(
      "telemetry.csv",
      "t_s,phase,battery_fraction\n0,standby,1\n10,takeoff,0.9\n20,explore,nan\n44,land,0.4\n50,done,0.3\n");
  EXPECT_NEAR(figures(dir)["energy_wh"].get<double>(), 0.5 * 300 * 6 / 60, 1e-9);
  dir.write("mission.info", "simulator\n{\nhover_power \"300 W\"\n}\n");
  EXPECT_TRUE(figures(dir)["energy_wh"].is_null());
}

TEST(Metrics, DepthIsThatOfTheFlightNotOfTheLandingSite) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", std::string(kPhases) + kLanded);
  std::string truth = "0 99 0 0 0 0 0 1\n";  // before the flight
  for (int i = 0; i <= 170; ++i) {           // 17 m in, 3 m down on the way, and back
    const double s = 0.2 * (i <= 85 ? i : 170 - i);
    truth += std::to_string(10 + 0.2 * i) + " " + std::to_string(s) + " 0 " + std::to_string(-3 * s / 17) +
             " 0 0 0 1\n";
  }
  dir.write("ground_truth.tum", truth);
  const ordered_json m = figures(dir);
  EXPECT_NEAR(m["depth_m"].get<double>(), std::hypot(17.0, 3.0), 0.3);
  EXPECT_NEAR(m["vertical_reach_m"].get<double>(), 3, 1e-6);
}

TEST(Metrics, CompletedIsAMissionAsItIsMeantToGo) {
  TemporaryDirectory dir;
  const auto completed = [&](const std::string& more_events, const std::string& end) {
    dir.write("events.jsonl", kPhases + more_events + end);
    return figures(dir)["completed"];
  };
  EXPECT_EQ(completed("", kLanded), 1);
  EXPECT_EQ(completed("", ""), 0) << "cut short";
  EXPECT_EQ(completed("", R"({"t":44,"kind":"outcome","outcome":"contact","reason":""})"
                          "\n"),
            0);
  const auto safety = [](int t, const char* action) {
    return "{\"t\": " + std::to_string(t) + ", \"kind\": \"safety\", \"action\": \"" + action + "\"}\n";
  };
  EXPECT_EQ(completed(safety(20, "brake") + safety(21, "slow"), kLanded), 1);
  EXPECT_EQ(completed(safety(32, "home"), kLanded), 0) << "sent home while exploring";
  EXPECT_EQ(completed(safety(35, "home"), kLanded), 1) << "another way on the way home";
  EXPECT_EQ(completed(safety(30, "land"), kLanded), 0);
  dir.write("ground_truth.tum", "0 0 0 0 0 0 0 1\n44 0.6 0.7 9 0 0 0 1\n");
  EXPECT_EQ(completed("", kLanded), 1);
  dir.write("ground_truth.tum", "0 0 0 0 0 0 0 1\n44 0.8 0.7 0 0 0 0 1\n");
  EXPECT_EQ(completed("", kLanded), 0) << "landed elsewhere than it thought";
}

TEST(Metrics, MapErrorIsMeanAndDeviationOfTheDistanceToRock) {
  TemporaryDirectory dir;  // rock is the plane z = 0; cells of 0.2 m with centres at 0.1, 0.3, 0.3, 0.9
  dir.write("mission.info", "map\n{\nresolution \"0.2 m\"\n}\n");
  std::string growth;
  const auto record = [&](std::int32_t z, std::int32_t t) {
    const std::int32_t r[4] = {0, z == 1 ? t : 0, z, t};
    growth.append(reinterpret_cast<const char*>(r), sizeof r);
  };
  record(0, 100);
  record(1, 200);
  record(1, 300);
  record(4, 300);
  record(9, 400);
  record(9, -500);  // gone again: does not count
  dir.write("map_growth.bin", growth);
  Truth truth;
  truth.distance_to_rock = [](const Vec3& p) { return p.z(); };
  const ordered_json m = figures(dir, truth);
  EXPECT_NEAR(m["map_error_mean_m"].get<double>(), 0.4, 1e-6);
  EXPECT_NEAR(m["map_error_std_m"].get<double>(), std::sqrt((0.09 + 0.01 + 0.01 + 0.25) / 4), 1e-6);
}

TEST(Metrics, AreTheSameBytesEveryTimeAndReadBack) {
  TemporaryDirectory dir;
  test::write_fake_run(dir.path());
  const ordered_json m = figures(dir);
  EXPECT_EQ(m.dump(), figures(dir).dump());
  write_metrics(dir.path(), m);
  std::ifstream in(dir.path() / "metrics.json");
  EXPECT_EQ(ordered_json::parse(in).dump(), m.dump());
  EXPECT_FALSE(std::filesystem::exists(dir.path() / "metrics.json.part"));
}

TEST(Metrics, OfAMadeUpFlightAreThoseItWasMadeWith) {
  TemporaryDirectory dir;
  test::FakeRunOptions o;
  o.drift_per_m = 0.01;
  test::write_fake_run(dir.path(), o);
  const ordered_json m = figures(dir);
  EXPECT_EQ(m["outcome"], "landed");
  EXPECT_NEAR(m["drift_percent"].get<double>(), 1.0, 0.01);
  EXPECT_NEAR(m["exploration_time_s"].get<double>(), (o.length_m - 6) / o.speed_mps, 0.2);
  EXPECT_NEAR(m["tracking_rms_m"].get<double>(), 0.01 * m["path_length_m"].get<double>() / std::sqrt(3), 0.02)
      << "its reference is where it truly is";
  EXPECT_NEAR(m["landing_error_m"].get<double>(), 0, 1e-6);
}

TEST(Metrics, CannotBeWrittenWhereTheDiskRefuses) {
  EXPECT_THROW(write_metrics("/proc/self", ordered_json::object()), core::InputError);
}

}  // namespace
}  // namespace karst::evaluation
