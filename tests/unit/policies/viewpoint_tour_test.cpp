#include <gtest/gtest.h>

#include <karst/testing/bench.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "policies/viewpoint_tour/path_lengths.h"
#include "policies/viewpoint_tour/tour.h"
#include "tests/unit/policies/sphere_sensor.h"

namespace {

using karst::testing::Bench;
using karst::testing::DrawnHost;
using karst::testing::DrawnMap;
using tour::Order;
using tour::Problem;

/// Stops at random in a square, with flight times that differ by direction and weights that differ much.
Problem random_problem(std::size_t n, std::mt19937& chance) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<std::array<double, 2>> at(n + 1);
  for (auto& p : at) p = {100 * uniform(chance), 100 * uniform(chance)};
  const auto leg = [&](std::size_t i, std::size_t j) {
    return 1 + std::hypot(at[i][0] - at[j][0], at[i][1] - at[j][1]) * (1 + 0.2 * uniform(chance));
  };
  Problem p;
  for (std::size_t i = 0; i < n; ++i) {
    p.weight.push_back(std::pow(100, uniform(chance)));
    p.first_s.push_back(leg(n, i));
    p.leg_s.emplace_back();
    for (std::size_t j = 0; j < n; ++j) p.leg_s[i].push_back(leg(i, j));
  }
  return p;
}

/// By trying every order.
double min_of_all(const Problem& p) {
  Order order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  double least = std::numeric_limits<double>::infinity();
  do {
    double t = 0, sum = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      t += i == 0 ? p.first_s[order[i]] : p.leg_s[order[i - 1]][order[i]];
      sum += t * p.weight[order[i]];
    }
    least = std::min(least, sum);
  } while (std::next_permutation(order.begin(), order.end()));
  return least;
}

TEST(Tour, IsMostlyTheBestOfAllOrdersAndNeverFarFromIt) {
  std::mt19937 chance(1);
  int best = 0;
  constexpr int rounds = 60;
  for (int round = 0; round < rounds; ++round) {
    const Problem p = random_problem(1 + static_cast<std::size_t>(round) % 8, chance);
    const Order order = tour::min_latency(p);
    ASSERT_EQ(std::set<std::size_t>(order.begin(), order.end()).size(), p.size()) << "every stop once";
    const double ratio = tour::latency(p, order) / min_of_all(p);
    EXPECT_GE(ratio, 1 - 1e-12);
    EXPECT_LT(ratio, 1.03);
    best += ratio < 1 + 1e-9;
  }
  EXPECT_GE(best, 54);
}

TEST(Tour, NoStopAloneWouldBeBetterElsewhere) {
  std::mt19937 chance(2);
  const Problem p = random_problem(25, chance);
  const Order order = tour::min_latency(p);
  const double cost = tour::latency(p, order);
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = 0; j < order.size(); ++j) {
      Order other = order;
      const std::size_t stop = other[i];
      other.erase(other.begin() + static_cast<std::ptrdiff_t>(i));
      other.insert(other.begin() + static_cast<std::ptrdiff_t>(j), stop);
      EXPECT_GE(tour::latency(p, other), cost - 1e-6);
    }
}

TEST(Tour, CanBeHeldToItsFirstStop) {
  std::mt19937 chance(4);
  for (int round = 0; round < 10; ++round) {
    const Problem p = random_problem(7, chance);
    for (std::size_t first = 0; first < 7; ++first) EXPECT_EQ(tour::beginning_with(p, first).front(), first);
  }
}

// Two passages beside each other, joined at their eastern ends.
DrawnMap hairpin() {
  return {1.0, {R"(
    ##################
    ?a....b.....c....#
    ################.#
    ?d....e.....f...s#
    ##################)"}};
}

TEST(PathLengths, AreThoseOfTheMapWhateverWasAskedBefore) {
  const DrawnHost host(hairpin());
  const DrawnMap& map = host.map();
  PathLengths lengths;
  karst_request_t r{};
  r.size = sizeof r;
  r.map = host.map_handle();
  for (const std::string names : {"ab", "abf", "cde", "fa", "abcdef"}) {
    r.stamp_ns += 50'000'000'000;  // long enough for places to be asked again, and forgotten
    std::vector<karst::Vec3> places;
    for (const char c : names) places.push_back(map.place(c));
    const std::vector<double> far(places.size(), 1000.0);
    const auto m = lengths.between(karst::Request(host.host(), r), places, far);
    for (std::size_t i = 0; i < places.size(); ++i)
      for (std::size_t j = 0; j < places.size(); ++j)
        EXPECT_NEAR(m[i][j], map.path_length_m(places[i], places[j]), 1e-9) << names[i] << names[j];
  }
}

TEST(PathLengths, LeadThroughWhereTheVehicleIsIfNoWayIsKnown) {
  const DrawnHost host(DrawnMap(1.0, {"a.#.b"}));
  karst_request_t r{};
  r.size = sizeof r;
  r.map = host.map_handle();
  PathLengths lengths;
  const auto m = lengths.between(karst::Request(host.host(), r),
                                 {host.map().place('a'), host.map().place('b')}, {10.0, 7.0});
  EXPECT_DOUBLE_EQ(m[0][1], 17.0);
}

/// The policy before frontiers at the letters, each of them with so many cells.
karst::Decision decide(const DrawnMap& map, const std::vector<std::pair<char, std::uint32_t>>& frontiers,
                       const Bench::Values& values) {
  Bench bench(karst_plugin_entry(), map, values);
  bench.sensors = {karst::test::sphere_sensor(10)};
  bench.position = map.place('s');
  std::uint32_t id = 0;
  for (const auto& [letter, cells] : frontiers)
    bench.offer(++id, map.place(letter), map.place(letter), cells);
  return bench.decide();
}

TEST(ViewpointTour, VisitsEveryFrontierOnceInOrder) {
  const karst::Decision d =
      decide(hairpin(), {{'a', 20}, {'c', 20}, {'d', 20}, {'f', 20}}, {{"turn_time", "0"}, {"passing", "0"}});
  EXPECT_TRUE(d.in_order);
  std::set<std::uint32_t> visited;
  for (const karst::Goal& g : d.goals) visited.insert(g.frontier_id);
  EXPECT_EQ(visited, (std::set<std::uint32_t>{1, 2, 3, 4}));
  EXPECT_EQ(d.goals.size(), 4u);
}

TEST(ViewpointTour, GoesByTheWayAndNotByTheCrow) {
  // From f, b lies two metres off through the wall, d ten by the way.
  const karst::Decision d =
      decide(hairpin(), {{'b', 20}, {'d', 20}, {'f', 20}}, {{"turn_time", "0"}, {"passing", "0"}});
  ASSERT_EQ(d.goals.size(), 3u);
  EXPECT_EQ(d.goals[0].frontier_id, 3u);
  EXPECT_EQ(d.goals[1].frontier_id, 2u);
}

TEST(ViewpointTour, WhatAStraightFlightPassesIsNoStop) {
  const std::vector<std::pair<char, std::uint32_t>> on_the_way = {{'d', 20}, {'e', 20}, {'f', 20}};
  const karst::Decision straight = decide(hairpin(), on_the_way, {{"turn_time", "0"}});
  ASSERT_EQ(straight.goals.size(), 1u);
  EXPECT_EQ(straight.goals[0].frontier_id, 1u);
  const DrawnMap round_the_end(1.0, {R"(
    ####################
    #b......a..........#
    #################..#
    #...........s......#
    ####################)"});
  EXPECT_EQ(decide(round_the_end, {{'a', 20}, {'b', 20}}, {{"turn_time", "0"}}).goals.size(), 2u);
}

TEST(ViewpointTour, ACameraThatLooksAheadStopsForWhatItPasses) {
  const DrawnMap map = hairpin();
  Bench bench(karst_plugin_entry(), map, {{"turn_time", "0"}});
  bench.sensors = {karst::test::sphere_sensor(10)};
  bench.sensors.front().horizontal_fov_rad = 1.4;
  bench.position = map.place('s');
  for (std::uint32_t id = 1; id <= 3; ++id) {
    const karst::Vec3 at = map.place("def"[id - 1]);
    bench.offer(id, at, at, 20);
  }
  EXPECT_EQ(bench.decide().goals.size(), 3u);
}

TEST(ViewpointTour, ALargeOpeningDoesNotWaitForASmallCornerOutOfTheWay) {
  const DrawnMap map(1.0, {R"(
    ????????????????????????
    ?a....s...............b?
    ????????????????????????)"});
  const Bench::Values values{{"turn_time", "0"},    {"gain_share", "0"},    {"gain_depth", "1"},
                             {"min_volume", "0.1"}, {"max_volume", "1000"}, {"min_cells", "1"}};
  const karst::Decision small = decide(map, {{'a', 1}, {'b', 60}}, values);
  EXPECT_EQ(small.goals.at(0).frontier_id, 2u);
  EXPECT_EQ(small.goals.at(1).frontier_id, 1u);
  const karst::Decision alike = decide(map, {{'a', 20}, {'b', 20}}, values);
  EXPECT_EQ(alike.goals.at(0).frontier_id, 1u) << "the nearer of two alike";
}

TEST(ViewpointTour, WorksWithoutAnyFrontier) {
  EXPECT_EQ(decide(hairpin(), {}, {{"patience", "0"}}).outcome, karst_outcome_t{KARST_OUTCOME_EXPLORED});
}

}  // namespace
