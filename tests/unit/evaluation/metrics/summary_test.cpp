#include "sdk/evaluation/metrics/summary.h"

#include <gtest/gtest.h>

namespace karst::evaluation {
namespace {

using nlohmann::ordered_json;

ordered_json metrics() {
  return {{"policy", "nearest_frontier"},  {"cave", "small"},    {"flight_time_s", 39.715},
          {"explored_volume_m3", 505.528}, {"coverage", 0.3867}, {"min_clearance_m", 0.3803}};
}
const Ending kWentHome{.as_meant = true,
                       .sentence = "home because nothing was left to explore; 62 % battery left"};

TEST(Summary, TellsWhoExploredHowMuchOfWhatHowFastHowCloseToRockAndHowItEnded) {
  EXPECT_EQ(
      summary_of(metrics(), kWentHome),
      "nearest_frontier explored 506 m³ of small (38.7 % of what can be reached) in 40 s, 0.38 m or more "
      "from rock; home because nothing was left to explore; 62 % battery left");
}

TEST(Summary, LeavesOutWhatIsNotKnown) {
  ordered_json m = metrics();
  for (const char* key : {"coverage", "min_clearance_m"}) m[key] = nullptr;
  EXPECT_EQ(achievement_of(m, kWentHome), "nearest_frontier explored 506 m³ of small in 40 s");
  m["explored_volume_m3"] = nullptr;
  EXPECT_EQ(achievement_of(m, kWentHome), "nearest_frontier flew in small for 40 s");
  m["flight_time_s"] = nullptr;
  EXPECT_EQ(achievement_of(m, kWentHome), "nearest_frontier flew in small");
  EXPECT_EQ(summary_of(ordered_json::object(), {}), "the vehicle flew");
  EXPECT_EQ(summary_of({{"policy", 3}, {"explored_volume_m3", "much"}}, {}), "the vehicle flew")
      << "damaged figures are not known";
}

TEST(Summary, OfAReplayTellsOfTheRecording) {
  ordered_json m = {{"policy", nullptr}, {"recording", "a.bag"},         {"scans", 384},
                    {"scans_lost", 0},   {"flight_time_s", 38.5},        {"path_length_m", 45.63},
                    {"loops_closed", 0}, {"loop_correction_m", nullptr}, {"explored_volume_m3", 539.1}};
  EXPECT_EQ(summary_of(m, {.sentence = "replayed: the recording ended"}),
            "a.bag: 384 scans in 38 s along 45.6 m, 539 m³ of free volume, no loop closed; replayed: the "
            "recording ended");
  m["scans_lost"] = 3;
  m["loops_closed"] = 1;
  EXPECT_EQ(achievement_of(m, {}),
            "a.bag: 384 scans, 3 of them lost, in 38 s along 45.6 m, 539 m³ of free volume, 1 loop closed");
  m["loops_closed"] = 5;
  m["loop_correction_m"] = 1.204;
  EXPECT_NE(achievement_of(m, {}).find("5 loops closed, positions corrected by up to 1.20 m"),
            std::string::npos);
}

TEST(Summary, WithASurveySaysWhatLiesBeyondIt) {
  ordered_json m = metrics();
  m["unsurveyed_volume_m3"] = 211.4;
  m["time_to_unsurveyed_50_s"] = 21.6;
  EXPECT_EQ(
      achievement_of(m, kWentHome),
      "nearest_frontier explored 506 m³ of small (38.7 % of what can be reached) in 40 s, 211 m³ beyond the "
      "survey (50 m³ after 22 s), 0.38 m or more from rock");
  m["unsurveyed_volume_m3"] = 3;
  m["time_to_unsurveyed_50_s"] = nullptr;
  EXPECT_NE(achievement_of(m, kWentHome).find("in 40 s, 3 m³ beyond the survey, 0.38 m"), std::string::npos);
}

TEST(Summary, WithAnEarlierMapSaysWhatIsNew) {
  ordered_json m = metrics();
  m["earlier_map_found"] = 1;
  m["added_volume_m3"] = 211.4;
  EXPECT_NE(achievement_of(m, kWentHome).find("in 40 s, 211 m³ of it not in the earlier map, 0.38 m"),
            std::string::npos);
  m["earlier_map_found"] = 0;
  m["added_volume_m3"] = nullptr;
  EXPECT_NE(achievement_of(m, kWentHome).find("in 40 s, its place in the earlier map not found, 0.38 m"),
            std::string::npos);
}

TEST(Summary, OfAFlightThatTouchedRockClaimsNoClearance) {
  ordered_json m = metrics();
  m["min_clearance_m"] = -0.01;
  EXPECT_EQ(achievement_of(m, kWentHome).find("from rock"), std::string::npos);
}

TEST(Summary, AfterAFailureOfThePolicyNamesTheFallback) {
  Ending ending = kWentHome;
  ending.failed_policy = FailedPolicy{6.7, "it crashed"};
  EXPECT_EQ(
      achievement_of(metrics(), ending).find("nearest_frontier, and after it failed the fallback, explored"),
      0u);
}

TEST(Summary, OfATeamCountsItsRobotsAndTakesTheWholeTime) {
  ordered_json m = metrics();
  m["flight_time_s"] = 170.0;  // of all robots together
  m["min_clearance_m"] = nullptr;
  m["duration_s"] = 95.2;
  m["robots"] = {ordered_json::object(), ordered_json::object()};
  EXPECT_EQ(
      achievement_of(m, kWentHome),
      "a team of 2 with nearest_frontier explored 506 m³ of small (38.7 % of what can be reached) in 95 s");
}

}  // namespace
}  // namespace karst::evaluation
