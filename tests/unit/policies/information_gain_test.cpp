#include <gtest/gtest.h>

#include <karst/testing/bench.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "tests/unit/policies/sphere_sensor.h"

namespace {

using karst::testing::Bench;
using karst::testing::DrawnMap;

// Behind a the unknown lies open, behind b a wall leaves one cell of it in sight.
DrawnMap passage() {
  return {1.0,
          {R"(
    ??????????????????
    ??a......s......b#
    ??????????????????)",
           R"(
    ??################
    ??################
    ??################)"}};
}

/// Unknown volume within `range_m` of the eye that no rock hides: cell by cell, in small steps along each
/// line.
double volume_in_sight(const DrawnMap& map, const karst::Vec3& eye, double range_m) {
  const double edge_m = map.resolution_m();
  const int radius = static_cast<int>(range_m / edge_m) + 2;
  const karst::testing::Index at = map.index_of(eye);
  double volume = 0;
  for (int x = -radius; x <= radius; ++x)
    for (int y = -radius; y <= radius; ++y)
      for (int z = -radius; z <= radius; ++z) {
        const karst::Vec3 cell = map.center_of({at.x + x, at.y + y, at.z + z});
        if (map.at(cell) != karst::Cell::unknown || karst::distance(cell, eye) > range_m) continue;
        bool hidden = false;
        for (double t = 0; t < 1; t += 0.002)
          hidden |= map.at(eye + t * (cell - eye)) == karst::Cell::occupied;
        volume += hidden ? 0 : edge_m * edge_m * edge_m;
      }
  return volume;
}

const karst::Goal& goal_of(const karst::Decision& d, std::uint32_t frontier) {
  return *std::find_if(d.goals.begin(), d.goals.end(),
                       [&](const karst::Goal& g) { return g.frontier_id == frontier; });
}

TEST(InformationGain, ScoreIsTheVolumeInSightOverTheTimeItTakes) {
  const DrawnMap map = passage();
  const Bench::Values plain = {{"gain_range", "2.5"}, {"gain_share", "0"}, {"gain_depth", "100"},
                               {"stop_time", "2"},    {"turn_time", "0"},  {"cruise", "0.5"},
                               {"max_volume", "1000"}};
  Bench bench(karst_plugin_entry(), map, plain);
  bench.sensors = {karst::test::sphere_sensor(10)};
  bench.position = map.place('s');
  // Off the cells' centres: from there many lines pass just through corners.
  const karst::Vec3 off(0.11, 0.07, 0.03), at_a = map.place('a') + off, at_b = map.place('b') + off;
  bench.offer(1, at_a, map.place('a'));
  bench.offer(2, at_b, map.place('b'));
  const karst::Decision d = bench.decide();
  ASSERT_EQ(d.goals.size(), 2u);
  const double a = volume_in_sight(map, at_a, 2.5), b = volume_in_sight(map, at_b, 2.5);
  ASSERT_GT(a, b);
  EXPECT_NEAR(goal_of(d, 1).score, a / (2 + 7 / 1.0), 1e-9);
  EXPECT_NEAR(goal_of(d, 2).score, b / (2 + 7 / 1.0), 1e-9);
}

class LittleIsLeft : public ::testing::Test {
 protected:
  explicit LittleIsLeft(const char* give_up = "60")
      : bench(karst_plugin_entry(), map,
              {{"gain_range", "2.5"},
               {"gain_share", "0"},
               {"gain_depth", "100"},
               {"little", std::to_string((much_m3 + little_m3) / 2)},
               {"give_up", give_up}}) {
    bench.sensors = {karst::test::sphere_sensor(10)};
    bench.position = map.place('s');
    offer_little();
  }
  void offer_little() {
    bench.frontiers.clear();
    bench.offer(1, map.place('b'), map.place('b'));
  }
  void offer_much() { bench.offer(2, map.place('a'), map.place('a')); }
  /// Asks every second; how many times it is to fly before the cave counts as explored, 200 at most.
  int flies() {
    for (int i = 0; i < 200; ++i) {
      bench.time_s += 1;
      if (bench.decide().outcome == KARST_OUTCOME_EXPLORED) return i;
    }
    return 200;
  }

  const DrawnMap map = passage();
  const double much_m3 = volume_in_sight(map, map.place('a'), 2.5),
               little_m3 = volume_in_sight(map, map.place('b'), 2.5);
  Bench bench;
};
struct LittleIsFlownToForEver : LittleIsLeft {
  LittleIsFlownToForEver() : LittleIsLeft("0") {}
};

TEST_F(LittleIsLeft, AMinuteOfFlightsToItIsEnough) {
  ASSERT_GT(much_m3, little_m3 + 1);
  EXPECT_EQ(flies(), 61);
  EXPECT_EQ(flies(), 0) << "it stays so";
}

TEST_F(LittleIsLeft, WhatShowsMuchBeginsTheMinuteAnew) {
  flies();
  offer_much();
  EXPECT_EQ(flies(), 200);
  offer_little();
  EXPECT_EQ(flies(), 60);
}

TEST_F(LittleIsLeft, TimeInWhichNobodyAsksDoesNotCount) {
  bench.decide();
  bench.time_s += 600;  // held by a pilot
  EXPECT_GT(flies(), 50);
}

TEST_F(LittleIsFlownToForEver, IfThePolicyIsToldTo) { EXPECT_EQ(flies(), 200); }

TEST(InformationGain, WithALidarTheShareOfTheViewCountsThatIsExpectedToBeCave) {
  const DrawnMap map = passage();
  const karst::Vec3 off(0.11, 0.07, 0.03), at = map.place('a') + off;
  const double in_view_m3 = volume_in_sight(map, at, 2.5);
  const auto score = [&](const char* share, std::uint32_t cells, double away_m) {
    Bench bench(karst_plugin_entry(), map,
                {{"gain_range", "2.5"},
                 {"gain_share", share},
                 {"stop_time", "2"},
                 {"turn_time", "0"},
                 {"cruise", "0.5"},
                 {"max_volume", "1000"},
                 {"passing", "0"}});
    bench.sensors = {karst::test::sphere_sensor(10)};
    bench.position = at + karst::Vec3(away_m, 0, 0);
    bench.offer(1, at, at, cells);
    return goal_of(bench.decide(), 1).score * (2 + bench.frontiers.at(0).path_length_m / 1.0) / in_view_m3;
  };
  EXPECT_NEAR(score("0.001", 25, 7), 0.001 * std::sqrt(25.0) * std::pow(8, 1.5), 1e-9);
  EXPECT_NEAR(score("0.001", 100, 3), 0.001 * std::sqrt(100.0) * std::pow(4, 1.5), 1e-9);
  EXPECT_NEAR(score("0.5", 100, 3), 1, 1e-9) << "no more than there is in view";
}

TEST(InformationGain, TheShareIsForSensorsThatSeeAllAroundAndForLooks) {
  const DrawnMap map = passage();
  const auto score = [&](const char* share, const char* looks, double fov_rad) {
    Bench bench(karst_plugin_entry(), map,
                {{"gain_range", "2.5"}, {"gain_share", share}, {"looks", looks}, {"turn_time", "0"}});
    bench.sensors = {karst::test::sphere_sensor(10)};
    bench.sensors.front().horizontal_fov_rad = fov_rad;
    bench.position = map.place('s');
    bench.offer(1, map.place('a'), map.place('a'), 25);
    return bench.decide().goals.at(0).score;
  };
  EXPECT_NE(score("0.001", "24", 6.3), score("0", "24", 6.3));
  EXPECT_EQ(score("0.001", "24", 1.4), score("0", "24", 1.4));
  EXPECT_EQ(score("0.001", "0", 6.3), score("0", "0", 6.3)) << "openings count without a look";
}

TEST(InformationGain, WithALidarAFrontierNotLookedAtCountsAsTheMeanOfTheOthers) {
  const DrawnMap map = passage();
  Bench bench(karst_plugin_entry(), map,
              {{"gain_range", "2.5"},
               {"gain_share", "0.001"},
               {"looks", "1"},
               {"turn_time", "0"},
               {"passing", "0"},
               {"max_volume", "1000"}});
  bench.sensors = {karst::test::sphere_sensor(10)};
  bench.position = map.place('s');
  bench.offer(1, map.place('a'), map.place('a'), 25);  // equally far from s as b
  bench.offer(2, map.place('b'), map.place('b'), 100);
  const karst::Decision d = bench.decide();
  EXPECT_NEAR(goal_of(d, 2).score, 2 * goal_of(d, 1).score, 1e-9) << "an opening four times as large";
}

TEST(InformationGain, ANarrowOpeningIsNotWorthAllTheUnknownBehindIt) {
  const DrawnMap map = passage();
  Bench bench(karst_plugin_entry(), map,
              {{"gain_share", "0"},
               {"gain_depth", "2"},
               {"gain_range", "3"},
               {"stop_time", "1"},
               {"turn_time", "0"}});
  bench.sensors = {karst::test::sphere_sensor(10)};
  bench.position = map.place('s');
  bench.offer(1, map.place('a'), map.place('a') - karst::Vec3(1, 0, 0), 10);
  EXPECT_NEAR(bench.decide().goals.at(0).score, 20 / (1 + 7 / 1.5), 1e-9)
      << "10 cells of a square metre, 2 m deep";
}

TEST(InformationGain, AGapBesideTheWayFlownIsWorthLittle) {
  const DrawnMap map = passage();
  Bench bench(karst_plugin_entry(), map,
              {{"gain_share", "0"},
               {"gain_depth", "2"},
               {"gain_range", "3"},
               {"stop_time", "1"},
               {"turn_time", "0"}});
  bench.sensors = {karst::test::sphere_sensor(10)};
  const karst::Vec3 a = map.place('a');
  bench.position = a + karst::Vec3(1, 0, 0);
  bench.offer(1, a, a - karst::Vec3(1, 0, 0), 10);
  bench.decide();
  bench.position = map.place('s');  // the way flown has come as near as 2 m
  bench.frontiers.clear();
  bench.offer(1, a, a - karst::Vec3(1, 0, 0), 10);
  EXPECT_NEAR(bench.decide().goals.at(0).score, 20 * (2 - 1.4) / (3 - 1.4) / (1 + 7 / 1.5), 1e-9);
}

TEST(InformationGain, KeepsItsGoalUnlessAnotherIsBetterByMore) {
  const DrawnMap map(1.0, {"??a......s.....b??"});
  Bench bench(karst_plugin_entry(), map, {{"gain_share", "0"}, {"turn_time", "0"}, {"keep", "0.5"}});
  bench.sensors = {karst::test::sphere_sensor(10)};
  bench.position = map.place('s');
  bench.offer(1, map.place('a'), map.place('a'));
  bench.offer(2, map.place('b'), map.place('b'));
  EXPECT_EQ(bench.decide().goals.at(0).frontier_id, 2u) << "a metre nearer";
  bench.last_fate = KARST_FATE_UNDER_WAY;
  bench.last_goal = map.place('a');
  EXPECT_EQ(bench.decide().goals.at(0).frontier_id, 1u);
}

TEST(InformationGain, LookingNoFartherThanSomethingCouldBeBetterLosesNothing) {
  // Many frontiers along a passage, with openings of all sizes. Their volume is bounded by the opening: the
  // best is known without any look.
  std::string row = "??";
  for (int i = 0; i < 120; ++i) row += '.';
  const DrawnMap map(1.0, {row + "??"});
  std::mt19937 chance(3);
  for (int round = 0; round < 20; ++round) {
    Bench bench(karst_plugin_entry(), map,
                {{"gain_share", "0"},
                 {"gain_depth", "0.5"},
                 {"turn_time", "0"},
                 {"stop_time", "1.5"},
                 {"max_volume", "20"},
                 {"passing", std::to_string(round % 2)},
                 {"gain_range", "2"}});
    bench.sensors = {karst::test::sphere_sensor(10)};
    bench.position = map.center_of({60, 0, 0});
    std::map<int, double> behind_m3;  // by the place along the passage
    std::uint32_t id = 0;
    for (int x = 3; x < 120; x += 4) {
      if (std::abs(x - 60) < 2) continue;
      const auto cells = 10 + static_cast<std::uint32_t>(chance() % 40);
      const karst::Vec3 at = map.center_of({x, 0, 0});
      bench.offer(++id, at, at, cells);
      behind_m3[x] = std::min(0.5 * cells, 20.0);
    }
    double best = 0;
    for (const auto& [x, own_m3] : behind_m3) {
      double shown_m3 = std::min(own_m3, volume_in_sight(map, map.center_of({x, 0, 0}), 2));
      if (round % 2 == 1)  // what lies between, but for the last 2 m
        for (const auto& [other, m3] : behind_m3)
          if ((other > 60) == (x > 60) && std::abs(other - 60) < std::abs(x - 60) - 2) shown_m3 += m3;
      best = std::max(best, shown_m3 / (1.5 + std::abs(x - 60) / 1.5));
    }
    EXPECT_NEAR(bench.decide().goals.at(0).score, best, 1e-9);
  }
}

TEST(InformationGain, WithALidarLookingNoFartherThanSomethingCouldBeBetterLosesNothing) {
  std::string row = "??";
  for (int i = 0; i < 80; ++i) row += '.';
  const DrawnMap map(1.0, {row + "??"});
  std::mt19937 chance(5);
  for (int round = 0; round < 20; ++round) {
    Bench bench(karst_plugin_entry(), map,
                {{"gain_share", "0.0003"},
                 {"turn_time", "0"},
                 {"stop_time", "1.5"},
                 {"max_volume", "1000"},
                 {"passing", "0"},
                 {"gain_range", "2"},
                 {"looks", "12"}});
    bench.sensors = {karst::test::sphere_sensor(10)};
    bench.position = map.center_of({40, 0, 0});
    double best = 0;
    for (int x = 3; x < 80; x += 4) {
      const auto cells = 1 + static_cast<std::uint32_t>(chance() % 100);
      const karst::Vec3 at = map.center_of({x, 0, 0});
      bench.offer(static_cast<std::uint32_t>(x), at, at, cells);
      const double away_m = std::abs(x - 40);
      const double share = std::min(1.0, 0.0003 * std::sqrt(cells) * std::pow(1 + away_m, 1.5));
      best = std::max(best, share * volume_in_sight(map, at, 2) / (1.5 + away_m / 1.5));
    }
    EXPECT_NEAR(bench.decide().goals.at(0).score, best, 1e-9);
  }
}

TEST(InformationGain, WhatIsPassedCountsForSensorsThatSeeItOnly) {
  const DrawnMap map(1.0, {"??s....a.........b??"});
  Bench bench(karst_plugin_entry(), map,
              {{"gain_share", "0"},
               {"turn_time", "0"},
               {"gain_depth", "1"},
               {"max_volume", "30"},
               {"stop_time", "2"}});
  bench.position = map.place('s');
  bench.offer(1, map.place('a'), map.place('a') + karst::Vec3(0, 1, 0), 25);
  bench.offer(2, map.place('b'), map.place('b'), 25);
  bench.sensors = {karst::test::sphere_sensor(10)};
  const double seen_b = goal_of(bench.decide(), 2).score;
  bench.sensors.front().horizontal_fov_rad = 1.4;
  const double unseen_b = goal_of(bench.decide(), 2).score;
  EXPECT_NEAR(seen_b - unseen_b, 25 / (2 + 15 / 1.5), 1e-9) << "what lies behind a, over the time to b";
}

TEST(InformationGain, WorksWithoutAnyFrontier) {
  Bench bench(karst_plugin_entry(), passage(), {{"patience", "0"}});
  EXPECT_EQ(bench.decide().outcome, karst_outcome_t{KARST_OUTCOME_EXPLORED});
}

}  // namespace
