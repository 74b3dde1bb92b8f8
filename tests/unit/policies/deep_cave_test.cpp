#include <gtest/gtest.h>

#include <karst/testing/bench.h>

#include "tests/unit/policies/sphere_sensor.h"

namespace {

using karst::testing::Bench;
using karst::testing::DrawnMap;

// The start is at s; a lies deep in the long passage, b at the end of a short one, c beside the way.
DrawnMap fork() {
  return {1.0, {R"(
    ###########################
    #######################...a?
    ###s...h....v.............#
    ###.######c################
    ###.######?################
    ###b#######################
    ###?#######################)"}};
}

struct Flight {
  DrawnMap map = fork();
  Bench bench;
  explicit Flight(Bench::Values values = {})
      : bench(karst_plugin_entry(), map, (values.push_back({"gain_share", "0"}), values)) {
    bench.sensors = {karst::test::sphere_sensor(10)};
    bench.position = map.place('s');
    bench.decide();  // here it begins
  }
  std::uint32_t choice(char from, double seconds_before_homing = 600) {
    bench.position = map.place(from);
    bench.seconds_before_homing = seconds_before_homing;
    for (karst::Frontier& f : bench.frontiers)
      f.path_length_m = map.path_length_m(bench.position, f.viewpoint);
    return bench.decide().goals.at(0).frontier_id;
  }
};

TEST(DeepCave, OfTwoOpeningsAlikeTakesTheOneDeeperInTheCave) {
  Flight flight;
  flight.bench.offer(1, flight.map.place('b'), flight.map.place('b'));
  flight.bench.offer(2, flight.map.place('a'), flight.map.place('a'));
  flight.bench.direction_of_flight = {0, -1, 0};
  EXPECT_EQ(flight.choice('h'), 2u) << "although b is nearer, and ahead";
}

TEST(DeepCave, ScoreIsTheDepthItMayReach) {
  Flight flight({{"turn_cost", "0"},
                 {"cruise", "0.5"},
                 {"even_volume", "10"},
                 {"reach", "1000"},
                 {"gain_depth", "0.5"}});
  flight.bench.offer(1, flight.map.place('a'), flight.map.place('a'), 20);
  flight.bench.position = flight.map.place('h');
  flight.bench.frontiers[0].path_length_m =
      flight.map.path_length_m(flight.bench.position, flight.map.place('a'));
  flight.bench.seconds_before_homing = 100;
  const double deep = flight.map.path_length_m(flight.map.place('s'), flight.map.place('a'));
  const double here = flight.map.path_length_m(flight.map.place('s'), flight.map.place('h'));
  const double detour = flight.bench.frontiers[0].path_length_m + deep - here;
  const double half = 0.5;  // 20 cells of a square metre, half a metre deep, are as much as even_volume
  EXPECT_NEAR(flight.bench.decide().goals.at(0).score, deep + half * (100 * 1.0 - detour) / 2, 1e-9);
}

TEST(DeepCave, DoesNotClearPocketsOnItsWay) {
  Flight flight;
  flight.bench.offer(1, flight.map.place('c'), flight.map.place('c') - karst::Vec3(0, 1, 0), 10);
  flight.bench.offer(2, flight.map.place('a'), flight.map.place('a'), 40);
  EXPECT_EQ(flight.choice('v'), 2u);
}

TEST(DeepCave, LeavesWhatTheTimeLeftDoesNotAllowFor) {
  // At the fork a large opening deep in the cave and one near the start: with a few seconds left only depth
  // itself counts, and what lies behind a place nothing.
  Flight flight({{"turn_cost", "0"}, {"keep_bonus", "0"}});
  flight.bench.offer(1, flight.map.place('b'), flight.map.place('b'), 400);
  flight.bench.offer(2, flight.map.place('c'), flight.map.place('c'), 10);
  EXPECT_EQ(flight.choice('h', 600), 1u) << "much more open";
  EXPECT_EQ(flight.choice('h', 5), 2u) << "deeper";
}

TEST(DeepCave, WorksWithoutAnyFrontier) {
  Bench bench(karst_plugin_entry(), fork(), {{"patience", "0"}});
  EXPECT_EQ(bench.decide().outcome, karst_outcome_t{KARST_OUTCOME_EXPLORED});
}

}  // namespace
