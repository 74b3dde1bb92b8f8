// Flights faster than 2 m/s: a rock that falls ahead.
//
//   KARST_SEEDS=20 build/bin/fast_flight_test     flies twenty; each prints a line of figures
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/closed_loop/command.h"
#include "tests/closed_loop/drawn_cave.h"

namespace karst {
namespace {

constexpr double kCruise_mps = 0.93 * 6, kMaxAcceleration_mps2 = 4;
// What the rule of speed takes (trusted_speeds.cpp): braking by 0.8 * 0.75 of the acceleration, three scans
// at 10 Hz, the budget of mapping, and half of the time in which jerk builds up the braking; and the
// clearance of paths.
constexpr double kBraking_mps2 = 0.6 * kMaxAcceleration_mps2, kReaction_s = 0.3 + 0.06 + 4.0 / 24,
                 kClearance_m = 0.6;

/// The distance within which the rule stops from `speed_mps`.
double stopping_distance_m(double speed_mps) {
  return speed_mps * kReaction_s + speed_mps * speed_mps / (2 * kBraking_mps2) + kClearance_m;
}

struct Fall {
  double speed_mps = 0, at_s = -1;
};
Fall fall_in(const std::filesystem::path& run) {
  Fall fall;
  std::istringstream truth(bytes_of(run / "truth_events.jsonl"));
  for (std::string line; std::getline(truth, line);) {
    if (line.find("rockfall") == std::string::npos) continue;
    const auto event = nlohmann::json::parse(line);
    fall = {event["speed_mps"], event["time_s"]};
  }
  return fall;
}

/// Seconds from then until the map forbids the path; infinite if it never does.
double noticed_after(const std::filesystem::path& run, double fell_s) {
  std::istringstream events(bytes_of(run / "events.jsonl"));
  for (std::string line; std::getline(events, line);) {
    const auto event = nlohmann::json::parse(line);
    if (event["kind"] == "safety" && event["t"] >= fell_s &&
        event["reason"] == "the map now forbids the path ahead")
      return event["t"].get<double>() - fell_s;
  }
  return std::numeric_limits<double>::infinity();
}

class FallingRockAtSixMetresPerSecond : public ::testing::TestWithParam<int> {};

/// A straight passage, 10 m wide, through which the vehicle flies home at full speed. A rock that fills it
/// falls as far ahead as the rule takes to stop, and with each seed a little farther. As its way home is
/// closed, the vehicle lands before the rock: once it gives up, or when the battery asks for it.
TEST_P(FallingRockAtSixMetresPerSecond, IsBrakedForWithoutContact) {
  const int seed = GetParam();
  const auto folder = fresh_folder("fast_falling_rock_" + std::to_string(seed));
  const std::vector<Box> boxes = {{{-6, -6, 0}, {6, 6, 7}}, {{6, -5, 0}, {180, 5, 7}}};
  const double turn = 0.29 * seed, radius_m = 15;
  const std::string cave = draw_cave(folder, boxes, {0, 0, 1}, turn);
  const double ahead_m = stopping_distance_m(kCruise_mps) + 0.4 * (seed - 1);  // the sensors reach 30 m
  const double x = (35 + 0.3 * seed) * std::cos(turn), y = (35 + 0.3 * seed) * std::sin(turn), z = 3.5;
  std::ofstream(cave, std::ios::app) << "boulder { position \"" << x << ' ' << y << ' ' << z << "\" radius \""
                                     << radius_m << " m\" within \"" << radius_m + ahead_m
                                     << " m\" after \"30 s\" }\n";
  const auto run = folder / "run";
  const Output out = run_karst(
      "fly --cave " + cave + " --policy deep_cave --seed " + std::to_string(seed) +
      " --set motion.max_speed=6m/s --set motion.max_acceleration=\"4 m/s^2\" --set "
      "mission.max_flight_time=110s"
      " --set simulator.pose.fitted=always --set localization.source=pose_sensor --quiet --no-report --out " +
      run.string());
  const auto metrics = nlohmann::json::parse(bytes_of(run / "metrics.json"), nullptr, false);
  ASSERT_TRUE(metrics.is_object()) << out.text;
  EXPECT_EQ(metrics["contacts"], 0);
  const std::string outcome = metrics["outcome"];
  EXPECT_TRUE(outcome == "stuck" || outcome == "battery") << outcome;
  const Fall fall = fall_in(run);
  ASSERT_GE(fall.at_s, 0) << "no rock fell";
  EXPECT_GT(fall.speed_mps, 4) << "it was to be fast";
  const double noticed_s = noticed_after(run, fall.at_s);
  // Along the passage, until it comes no nearer to the rock.
  double nearest_m = ahead_m, before_m = ahead_m;
  std::istringstream poses(bytes_of(run / "ground_truth.tum"));
  for (std::string line; std::getline(poses, line);) {
    double t = 0, px = 0, py = 0, pz = 0;
    if (!(std::istringstream(line) >> t >> px >> py >> pz) || t < fall.at_s) continue;
    const double gap_m = std::hypot(px - x, py - y, pz - z) - radius_m;
    if (gap_m > before_m + 1e-3) break;
    before_m = gap_m;
    nearest_m = std::min(nearest_m, gap_m);
  }
  std::printf(
      "rock %.2f m ahead at %.2f m/s: noticed after %.2f s, %.2f m left; hull at least %.2f m from rock\n",
      ahead_m, fall.speed_mps, noticed_s, nearest_m, metrics["min_clearance_m"].get<double>());
  EXPECT_LT(noticed_s, kReaction_s);
  EXPECT_GT(nearest_m, kClearance_m) << "the rule stops at the clearance of paths";
}
INSTANTIATE_TEST_SUITE_P(Seeds, FallingRockAtSixMetresPerSecond, ::testing::Range(1, 1 + seeds()));

}  // namespace
}  // namespace karst
