#include "core_stack/mission/world_model/team_membership.h"

#include <gtest/gtest.h>

#include "tests/unit/homing/passage.h"

namespace karst::core {
namespace {

/// A robot that flies along a passage, with the map and the roadmap of it.
struct Passage {
  std::vector<CellChange> changes;
  VoxelMap map = testing::passage(4, 3.2, 20, &changes);
  PlanningOptions planning;
  Roadmap roadmap{planning};
  TeamNews news;

  Passage() { roadmap.update(map, changes); }
  RelayHoming homing() const { return {1, {{}, {}, planning, {}, 0.3, Vec3(-8, 0.1, 1)}}; }
  /// What a robot reports in sum that flies past and is told of a wall in between.
  std::size_t rays_reported(TeamMembership& team, const std::vector<CellChange>& seen) {
    std::size_t rays = 0;
    for (double x = -8; x < 0; x += 1) rays += team.share(map, roadmap, {x, 0.1, 1}, news).rays.size();
    team.note(seen);
    for (double x = 0; x < 8; x += 1) rays += team.share(map, roadmap, {x, 0.1, 1}, news).rays.size();
    return rays;
  }
};

TEST(Claims, HoldWhatIsWithinTheirRadius) {
  const Claims claims{{Vec3(0, 0, 0), Vec3(10, 0, 0)}, 2};
  EXPECT_TRUE(claims.hold(Vec3(1.99, 0, 0)));
  EXPECT_TRUE(claims.hold(Vec3(10, 1.9, 0)));
  EXPECT_FALSE(claims.hold(Vec3(2, 0, 0)));
  EXPECT_FALSE(Claims{}.hold(Vec3::Zero()));
}

TEST(TeamMembership, AloneAVehicleClaimsNothing) {
  TeamMembership alone;
  EXPECT_EQ(alone.homing(), nullptr);
  EXPECT_TRUE(alone.claims().goals.empty());
}

TEST(TeamMembership, ClaimsAreTheGoalsHeardLast) {
  Passage p;
  RelayHoming homing = p.homing();
  TeamMembership team;
  team.join(&homing, 4);
  p.news.goals = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
  team.share(p.map, p.roadmap, {0, 0.1, 1}, p.news);
  EXPECT_EQ(team.claims().goals, p.news.goals);
  EXPECT_EQ(team.claims().radius_m, 4);
  p.news.goals = {};
  team.share(p.map, p.roadmap, {0, 0.1, 1}, p.news);
  EXPECT_TRUE(team.claims().goals.empty());
}

TEST(TeamMembership, ReportsTheRockThatWasSeenSinceItJoinedOnce) {
  Passage p;
  std::vector<CellChange> wall;
  testing::draw(
      p.map, {-22, -10, 0}, {-20, 10, 15}, [](const CellKey&) { return Cell::occupied; }, &wall);
  for (int i = 0; i < 3; ++i)
    testing::draw(
        p.map, {-22, -10, 0}, {-20, 10, 15}, [](const CellKey&) { return Cell::occupied; }, &wall);
  ASSERT_TRUE(
      std::any_of(wall.begin(), wall.end(), [](const CellChange& c) { return c.after == Cell::occupied; }));
  const auto reported = [&](const std::vector<CellChange>& seen) {
    RelayHoming homing = p.homing();
    TeamMembership team;
    team.note(wall);  // before it joined
    team.join(&homing, 4);
    return p.rays_reported(team, seen);
  };
  // The same by RelayHoming itself: told of the rock once.
  RelayHoming twin = p.homing();
  std::vector<CellKey> rock;
  for (const CellChange& c : wall)
    if (c.after == Cell::occupied) rock.push_back(c.key);
  std::size_t oracle = 0;
  for (double x = -8; x < 8; x += 1) {
    const std::vector<CellKey> told = x == 0 ? rock : std::vector<CellKey>{};
    oracle += twin.update(p.map, p.roadmap, {x, 0.1, 1}, p.news, told).rays.size();
  }
  EXPECT_EQ(reported(wall), oracle);
  std::vector<CellChange> freed = wall;
  for (CellChange& c : freed) c.after = Cell::free;
  EXPECT_EQ(reported(freed), reported({}));
  EXPECT_NE(reported(wall), reported({})) << "rock matters";
}

}  // namespace
}  // namespace karst::core
