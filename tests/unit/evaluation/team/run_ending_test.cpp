// The ending of a run directory, from its events and metrics.json alone.
#include "sdk/evaluation/team/run_ending.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using test::TemporaryDirectory;

constexpr const char* kHomeEvents = R"({"t": 1, "kind": "phase", "phase": "takeoff"}
{"t": 4, "kind": "phase", "phase": "explore"}
{"t": 64, "kind": "phase", "phase": "home", "reason": "explored: no frontier can be reached"}
{"t": 92, "kind": "outcome", "outcome": "landed", "reason": "at the start"}
)";
constexpr const char* kLostEvents = R"({"t": 1, "kind": "phase", "phase": "takeoff"}
{"t": 4, "kind": "phase", "phase": "explore"}
{"t": 5, "kind": "safety", "action": "land", "reason": "the state estimate is lost: no pose for too long"}
{"t": 5, "kind": "phase", "phase": "land", "reason": "the state estimate is lost: no pose for too long"}
{"t": 7, "kind": "outcome", "outcome": "landed", "reason": "at the start"}
)";

TEST(RunEnding, OfAVehicleIsThatOfItsEventsAndFigures) {
  TemporaryDirectory dir;
  EXPECT_EQ(read_ending(dir.path()).sentence, "") << "no events";
  dir.write("events.jsonl", kHomeEvents);
  EXPECT_EQ(read_ending(dir.path()).sentence, "home because nothing was left to explore");
  EXPECT_TRUE(read_ending(dir.path()).as_meant);
  dir.write("metrics.json", R"({"battery_left": 0.622, "landing_error_m": 1.5})");
  EXPECT_EQ(read_ending(dir.path()).sentence,
            "home because nothing was left to explore; landed 1.5 m from the start; 62 % battery left");
  EXPECT_FALSE(read_ending(dir.path()).as_meant);
  dir.write("metrics.json", "{}");
  std::string events = kHomeEvents;
  events.replace(events.find("explored: no frontier can be reached"),
                 std::string("explored: no frontier can be reached").size(),
                 "the time allowed only just suffices for the way home");
  dir.write("events.jsonl", events);
  dir.write("mission.info", "mission {\n    home_reserve \"20 s\"\n}\n");
  EXPECT_EQ(read_ending(dir.path()).sentence,
            "home because the time allowed only just sufficed for the way home, with 20 s in reserve");
  dir.write("metrics.json", "{cut");
  dir.write("events.jsonl", kHomeEvents);
  EXPECT_TRUE(read_ending(dir.path()).as_meant) << "damaged figures are not known";
  dir.write("events.jsonl", kLostEvents);
  EXPECT_EQ(read_ending(dir.path()).sentence, "home after 4 s: the pose was lost (no pose for too long)");
  EXPECT_FALSE(read_ending(dir.path()).as_meant);
  EXPECT_EQ(read_ending(dir.path() / "nowhere").sentence, "");
}

TEST(RunEnding, OfATeamIsOneForEachRobotAndAsMeantIfAllAre) {
  TemporaryDirectory dir;
  for (const char* robot : {"robot_1", "robot_2"}) std::filesystem::create_directory(dir.path() / robot);
  dir.write("team.jsonl", "{\"t\": 0, \"kind\": \"team\", \"robots\": 2}\n");
  dir.write("robot_1/events.jsonl", kHomeEvents);
  dir.write("robot_2/events.jsonl", kHomeEvents);
  ASSERT_EQ(read_endings(dir.path()).size(), 2u);
  EXPECT_TRUE(read_ending(dir.path()).as_meant);
  EXPECT_EQ(read_ending(dir.path()).sentence, "all 2 robots flew as planned");
  dir.write("robot_2/events.jsonl", kLostEvents);
  EXPECT_FALSE(read_ending(dir.path()).as_meant);
  EXPECT_EQ(read_ending(dir.path()).sentence,
            "robot 2: home after 4 s: the pose was lost (no pose for too long)");
  EXPECT_TRUE(read_endings(dir.path())[0].as_meant);
  std::filesystem::remove_all(dir.path() / "robot_2");
  EXPECT_EQ(read_ending(dir.path()).sentence, "") << "a robot's folder is missing";
  EXPECT_FALSE(read_ending(dir.path()).as_meant);
}

}  // namespace
}  // namespace karst::evaluation
