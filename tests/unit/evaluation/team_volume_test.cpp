// What a team knows when, against unions counted by hand.
#include "sdk/evaluation/team_volume.h"

#include <gtest/gtest.h>

#include "core_stack/common/error.h"
#include "sdk/evaluation/team_record.h"
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
