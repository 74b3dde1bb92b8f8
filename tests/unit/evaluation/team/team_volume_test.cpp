// What a team knows when, against unions counted by hand.
#include "sdk/evaluation/team/team_volume.h"

#include <gtest/gtest.h>

#include "core_stack/common/error.h"
#include "sdk/evaluation/team/team_folders.h"
#include "sdk/evaluation/team/team_record.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

/// Knows 10 m3 and `first` .. `first` + 9 of rock's cells from `begin_s` to 60 s.
RunRecord robot(double begin_s, std::int32_t first) {
  RunRecord r;
  r.telemetry.numbers = {{"t_s", {begin_s, 60}}, {"explored_m3", {10, 10}}};
  r.telemetry.rows = 2;
  for (std::int32_t x = first; x < first + 10; ++x)
    r.growth.push_back({{x, 0, 0}, static_cast<std::int32_t>(1000 * begin_s), OccupiedSpan::kNever});
  return r;
}

std::vector<OccupiedSpan> cells(std::int32_t low, std::int32_t high, std::int32_t from_ms) {
  std::vector<OccupiedSpan> out;
  for (std::int32_t x = low; x < high; ++x) out.push_back({{x, 0, 0}, from_ms, OccupiedSpan::kNever});
  return out;
}

TEST(TeamVolume, CountsOnceWhatTwoRobotsKnow) {
  auto united = cells(0, 10, 0);
  for (const OccupiedSpan& s : cells(10, 15, 30000)) united.push_back(s);
  const auto curve = team_volume_curve({robot(0, 0), robot(30, 5)}, united, std::nullopt);
  ASSERT_EQ(curve.t_s.size(), 61u);
  EXPECT_DOUBLE_EQ(curve.explored_m3[29], 10);
  EXPECT_DOUBLE_EQ(curve.explored_m3[30], 15) << "half of what the second knows is new";
  // A final map that knows better is met at the end, and leaves the time of one robot as it was.
  const auto exact = team_volume_curve({robot(0, 0), robot(30, 5)}, united, 12.0);
  EXPECT_DOUBLE_EQ(exact.explored_m3[29], 10);
  EXPECT_DOUBLE_EQ(exact.explored_m3.back(), 12);
}

// A robot that has just started knows room, but hardly any rock yet: its overlap was found too small.
TEST(TeamVolume, IsNeverMoreThanLaterAndEndsWithTheMap) {
  RunRecord late = robot(30, 0);
  for (OccupiedSpan& s : late.growth) s.from_ms = 40000;
  const auto curve = team_volume_curve({robot(0, 0), late}, cells(0, 10, 0), 10.0);
  for (std::size_t i = 0; i < curve.t_s.size(); ++i) EXPECT_DOUBLE_EQ(curve.explored_m3[i], 10) << i;
}

TEST(TeamVolume, OfOneRobotIsItsOwn) {
  const auto curve = team_volume_curve({robot(0, 0)}, cells(0, 10, 0), std::nullopt);
  EXPECT_DOUBLE_EQ(curve.explored_m3.front(), 10);
  EXPECT_DOUBLE_EQ(curve.explored_m3.back(), 10);
  EXPECT_TRUE(team_volume_curve({RunRecord{}}, {}, std::nullopt).t_s.empty());
}

TEST(TeamRecord, IsRefusedWithoutLogOrRobots) {
  test::TemporaryDirectory dir;
  EXPECT_THROW(read_team(dir.path()), core::InputError);
  dir.write("team.jsonl", "");
  EXPECT_THROW(read_team(dir.path()), core::InputError);
}

std::string refusal(const std::filesystem::path& run_dir) {
  try {
    read_team(run_dir);
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

TEST(TeamRecord, NamesTheRobotWhoseFolderIsMissing) {
  test::TemporaryDirectory dir;
  for (const char* robot : {"robot_1", "robot_3"}) std::filesystem::create_directories(dir.path() / robot);
  dir.write("team.jsonl", "{\"t\":0,\"kind\":\"team\",\"robots\":3}\n");
  EXPECT_NE(refusal(dir.path()).find("robot_2: not there, though team.jsonl says that the team had 3 robots"),
            std::string::npos)
      << refusal(dir.path());
  std::filesystem::create_directories(dir.path() / "robot_2");
  EXPECT_EQ(refusal(dir.path()), "");
  dir.write("team.jsonl", "damaged\n");
  dir.write("mission.info", "team\n{\n robots 4\n}\n");
  EXPECT_NE(refusal(dir.path()).find("robot_4: not there, though mission.info"), std::string::npos);
}

TEST(TeamRecord, IsKnownForATeamsByAnyTrace) {
  test::TemporaryDirectory by_log, by_robot, by_mission, alone;
  by_log.write("team.jsonl", "");
  std::filesystem::create_directories(by_robot.path() / "robot_1");
  by_mission.write("mission.info", "team\n{\n robots 2\n}\n");
  alone.write("mission.info", "team\n{\n robots 1\n}\n");
  for (const auto* dir : {&by_log, &by_robot, &by_mission}) EXPECT_TRUE(is_team(dir->path()));
  EXPECT_FALSE(is_team(alone.path()));
}

TEST(TeamRecord, LeavesOutTimesThatNoMissionLasts) {
  test::TemporaryDirectory dir;
  test::write_fake_run(dir.path() / "robot_1");
  dir.write("team.jsonl", "{\"t\":5,\"kind\":\"start\",\"robot\":1}\n");
  const TeamRecord sound = read_team(dir.path());
  for (const char* bad : {"1e9", "1e300", "-1e9"}) {
    dir.write("team.jsonl", std::string("{\"t\":5,\"kind\":\"start\",\"robot\":1}\n{\"t\":") + bad +
                                ",\"kind\":\"start\",\"robot\":1}\n");
    const TeamRecord team = read_team(dir.path());
    EXPECT_EQ(team.duration_s, sound.duration_s);
    EXPECT_EQ(team.merged.telemetry.rows, sound.merged.telemetry.rows);
    ASSERT_EQ(team.problems.size(), sound.problems.size() + 1);
    EXPECT_EQ(team.problems.front(),
              "team.jsonl: line 2: its \"t\" is longer than a mission can last; left out");
  }
}

TEST(TeamVolume, OfATelemetryWithADamagedTimeEnds) {
  RunRecord damaged = robot(0, 0);
  damaged.telemetry.numbers["t_s"].back() = 1e12;
  EXPECT_LE(team_volume_curve({damaged}, {}, std::nullopt).t_s.size(), kLongestRun_s + 2);
}

TEST(TeamRecord, PutsARobotsTimesIntoTheTeams) {
  test::TemporaryDirectory dir;
  test::write_fake_run(dir.path() / "robot_1");
  test::write_fake_run(dir.path() / "robot_2");
  dir.write("team.jsonl",
            "{\"t\":0,\"kind\":\"start\",\"robot\":1}\n{\"t\":40,\"kind\":\"start\",\"robot\":2}\n");
  const TeamRecord team = read_team(dir.path());
  ASSERT_EQ(team.robots.size(), 2u);
  const RunRecord &a = team.robots[0], &b = team.robots[1];
  ASSERT_EQ(a.phases.size(), b.phases.size());
  EXPECT_DOUBLE_EQ(b.phases[0].begin_s, a.phases[0].begin_s + 40);
  EXPECT_DOUBLE_EQ(b.telemetry.times()->back(), a.telemetry.times()->back() + 40);
  EXPECT_EQ(b.growth.front().from_ms, a.growth.front().from_ms + 40000);
  EXPECT_EQ(team.merged.growth.size(), a.growth.size()) << "both know the same cells";
}

}  // namespace
}  // namespace karst::evaluation
