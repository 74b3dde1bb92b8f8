// The policy without the host's account: it keeps its own, from the poses at which it is asked.
#include <gtest/gtest.h>

#include <karst/testing/bench.h>

#include <cmath>

#include "policies/surface_coverage/candidates.h"

namespace {

using karst::Vec3;
using karst::testing::Bench;
using karst::testing::DrawnHost;
using karst::testing::DrawnMap;

/// A hall, walled all around; 's' in its middle, half way up. Cells of 0.5 m.
DrawnMap hall(int length, int width, int height) {
  std::vector<std::string> layers;
  for (int z = 0; z < height; ++z) {
    std::string layer;
    for (int y = 0; y < width; ++y, layer += '\n')
      for (int x = 0; x < length; ++x) {
        const bool wall = x == 0 || y == 0 || z == 0 || x == length - 1 || y == width - 1 || z == height - 1;
        const bool start = x == length / 2 && y == width / 2 && z == height / 2;
        layer += wall ? '#' : start ? 's' : '.';
      }
    layers.push_back(layer);
  }
  return {0.5, layers};
}

/// The drawn host is slow: few patches and stops.
const Bench::Values kQuick = {{"patches", "6"}, {"stops", "2"}};

karst::Sensor camera() {
  karst::Sensor s{};
  s.kind = KARST_SENSOR_RGB;
  s.T_body_sensor.orientation.w = 1;
  s.min_range_m = 0.3, s.max_range_m = 6;
  s.horizontal_fov_rad = 1.4;
  s.low_elevation_rad = -0.56, s.high_elevation_rad = 0.56;
  return s;
}

/// Flies the policy by jumping from goal to goal; returns the decisions until it says explored.
struct Flight {
  std::vector<karst::Goal> goals;
  karst::Decision last;
  bool ended = false;
};
Flight fly(Bench& bench, int decisions) {
  Flight flight;
  for (int i = 0; i < decisions; ++i) {
    bench.time_s += 4;
    flight.last = bench.decide();
    if (flight.last.outcome == KARST_OUTCOME_EXPLORED) {
      flight.ended = true;
      return flight;
    }
    if (flight.last.goals.empty()) continue;
    const karst::Goal& g = flight.last.goals.front();
    flight.goals.push_back(g);
    bench.tell(KARST_EVENT_GOAL_REACHED, g);
    bench.position = g.position;
    bench.heading_rad = g.heading_rad;
    bench.direction_of_flight = {std::cos(g.heading_rad), std::sin(g.heading_rad), 0};
  }
  return flight;
}

TEST(SurfaceCoverage, LooksAtEveryWallOfAHallAndIsDone) {
  const DrawnMap map = hall(14, 12, 7);
  Bench bench(karst_plugin_entry(), map, kQuick);
  bench.position = map.place('s');
  bench.sensors = {camera()};
  const Flight flight = fly(bench, 60);
  EXPECT_TRUE(flight.ended) << "ended with: " << flight.last.reason;
  ASSERT_GE(flight.goals.size(), 4u) << "one look does not show all walls";
  bool north = false, south = false, east = false, west = false;
  for (const karst::Goal& g : flight.goals) {
    EXPECT_EQ(map.at(g.position), karst::Cell::free);
    EXPECT_NE(g.why.find("picture"), std::string::npos);
    north |= std::sin(g.heading_rad) > 0.6, south |= std::sin(g.heading_rad) < -0.6;
    east |= std::cos(g.heading_rad) > 0.6, west |= std::cos(g.heading_rad) < -0.6;
  }
  EXPECT_TRUE(north && south && east && west);
}

TEST(SurfaceCoverage, TheSameRequestsGetTheSameAnswers) {
  const DrawnMap map = hall(12, 12, 7);
  std::vector<std::vector<Vec3>> places(2);
  for (auto& run : places) {
    Bench bench(karst_plugin_entry(), map, kQuick);
    bench.position = map.place('s');
    bench.sensors = {camera()};
    for (const karst::Goal& g : fly(bench, 12).goals) run.push_back(g.position);
  }
  ASSERT_EQ(places[0].size(), places[1].size());
  for (std::size_t i = 0; i < places[0].size(); ++i) EXPECT_EQ(distance(places[0][i], places[1][i]), 0);
}

TEST(SurfaceCoverage, GivesUpWhatPicturesDoNotShow) {
  // The vehicle says it was there, but looked the other way each time: cells stay unseen.
  const DrawnMap map = hall(12, 10, 7);
  Bench bench(karst_plugin_entry(), map, {{"tries", "1"}, {"patches", "6"}, {"stops", "2"}});
  bench.position = map.place('s');
  bench.sensors = {camera()};
  bool ended = false;
  for (int i = 0; i < 80 && !ended; ++i) {
    bench.time_s += 4;
    const karst::Decision d = bench.decide();
    ended = d.outcome == KARST_OUTCOME_EXPLORED;
    if (ended) {
      EXPECT_NE(d.reason.find("given up"), std::string::npos);
    }
    if (!d.goals.empty()) bench.tell(KARST_EVENT_GOAL_REACHED, d.goals.front());
  }
  EXPECT_TRUE(ended);
}

TEST(SurfaceCoverage, AGoalRefusedIsNotProposedAgainAtOnce) {
  const DrawnMap map = hall(14, 12, 7);
  Bench bench(karst_plugin_entry(), map, kQuick);
  bench.position = map.place('s');
  bench.sensors = {camera()};
  bench.time_s = 1;
  const karst::Decision first = bench.decide();
  ASSERT_FALSE(first.goals.empty());
  for (const karst::Goal& g : first.goals) bench.tell(KARST_EVENT_GOAL_REJECTED, g, "no path");
  bench.time_s = 2;
  for (const karst::Goal& again : bench.decide().goals)
    for (const karst::Goal& g : first.goals)
      if (distance(g.position, bench.position) > 0.1) {
        EXPECT_GT(distance(again.position, g.position), 0.5);
      }
}

TEST(SurfaceCoverage, WithNothingToLookAtItGoesToTheFrontier) {
  const DrawnMap map(0.5, {R"(
    ......
    .a..b.
    ......)"});
  Bench bench(karst_plugin_entry(), map);
  bench.position = map.place('a');
  bench.sensors = {camera()};
  bench.offer(4, map.place('b'), map.place('b'), 40);
  const karst::Decision d = bench.decide();
  ASSERT_EQ(d.goals.size(), 1u);
  EXPECT_EQ(d.goals[0].frontier_id, 4u);
}

/// The cells of the map's surface, whatever boxes were asked for before, in the map's order.
TEST(OwnMemory, TellsOfTheSurfaceInABoxAsTheMapDoes) {
  const DrawnHost host(hall(14, 12, 7));
  karst_request_t r{};
  r.size = sizeof r;
  r.map = host.map_handle();
  r.state.orientation.w = 1;
  const Vec3 middle = host.map().place('s');
  r.state.position = middle + Vec3(0, 0, 100);  // from there nothing is seen
  const karst::Request request(host.host(), r);
  surface_coverage::OwnMemory memory;
  const auto account = memory.update(request);
  std::size_t cells = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3 at = middle + Vec3(0.37 * (i % 7) - 1.5, 0.25 * (i % 13) - 2, 0.5 * (i % 5) - 1);
    karst::Box box = karst::box_around(at, i == 40 ? 30.0 : 0.25 * (i % 11));
    box.high.x += i % 3;
    const std::vector<Vec3> expected = request.map.surface(box);
    const std::vector<karst::SurfaceCell> found = account->unimaged(box);
    ASSERT_EQ(found.size(), expected.size()) << i;
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_EQ(karst::distance(found[k].center, expected[k]), 0) << i;
    cells += found.size();
  }
  EXPECT_GT(cells, 500u);
}

TEST(Patches, AreCellsOfOneCubeThatFaceTheSameWay) {
  std::vector<karst::SurfaceCell> cells;
  for (int i = 0; i < 4; ++i) cells.push_back({{0.1 + 0.2 * i, 0.1, 0.1}, {0, 0, 1}});
  for (int i = 0; i < 3; ++i) cells.push_back({{0.1, 0.1, 0.3 + 0.2 * i}, {1, 0, 0}});
  cells.push_back({{5.1, 0.1, 0.1}, {0, 0, 1}});
  const auto patches = surface_coverage::patches_of(cells, 1.0);
  ASSERT_EQ(patches.size(), 3u);
  std::size_t sum = 0;
  for (const auto& p : patches) sum += p.cells;
  EXPECT_EQ(sum, cells.size());
}

}  // namespace
