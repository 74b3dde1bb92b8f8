// The test kit itself: generated maps, frontiers found in drawings, scripts, expectations.
#include <gtest/gtest.h>

#include <karst/policy.h>
#include <karst/testing/script.h>

namespace {

using namespace karst::testing;
using karst::Cell;
using karst::Decision;

TEST(DrawnMap, LegendGivesOtherCharactersAMeaning) {
  const DrawnMap map(1.0, {"~#x"}, {{'~', Cell::free}, {'x', Cell::unknown}});
  EXPECT_EQ(map.at(karst::Vec3{0.5, 0.5, 0.5}), Cell::free);
  EXPECT_EQ(map.at(karst::Vec3{1.5, 0.5, 0.5}), Cell::occupied);
  EXPECT_EQ(map.at(karst::Vec3{2.5, 0.5, 0.5}), Cell::unknown);
  EXPECT_THROW(map.place('x'), std::out_of_range) << "a place must be free";
}

TEST(DrawnMap, RoomIsFreeInsideAndWalledAround) {
  DrawnMap map(1.0, {});
  map.room({{0, 0, 0}, {3, 2, 2}});
  int free = 0, occupied = 0;
  for (const auto& [i, cell] : map.known()) ++(cell == Cell::free ? free : occupied);
  EXPECT_EQ(free, 3 * 2 * 2);
  EXPECT_EQ(occupied, 5 * 4 * 4 - free);
}

TEST(DrawnMap, TubeIsOpenAtItsEndsAndClosedAtItsSides) {
  DrawnMap map(0.5, {});
  map.tube({0.25, 0.25, 0.25}, {8.25, 0.25, 0.25}, 1.0);
  EXPECT_NEAR(map.path_length_m({0.25, 0.25, 0.25}, {8.25, 0.25, 0.25}), 8.0, 1e-9);
  EXPECT_EQ(map.at(karst::Vec3{4.25, 0.75, 0.75}), Cell::free);
  EXPECT_EQ(map.at(karst::Vec3{4.25, 1.75, 0.25}), Cell::occupied);
  EXPECT_EQ(map.at(karst::Vec3{-0.25, 0.25, 0.25}), Cell::unknown);
  for (const auto& [i, cell] : map.known()) {  // by its definition
    const karst::Vec3 c = map.center_of(i);
    EXPECT_EQ(cell == Cell::free, std::hypot(c.y - 0.25, c.z - 0.25) <= 1.0) << describe(c);
  }
  const std::vector<karst::Frontier> ends = find_frontiers(map, {4.25, 0.25, 0.25});
  ASSERT_EQ(ends.size(), 2u);
  EXPECT_NEAR(ends[0].normal.x, -1, 1e-9);
  EXPECT_NEAR(ends[1].normal.x, 1, 1e-9);
  EXPECT_EQ(ends[0].cells, 13u) << "cells of half a metre whose centres lie within a metre of the axis";
  EXPECT_NEAR(ends[1].path_length_m, 4.0, 1e-9);
}

TEST(DrawnHost, PathsHavePointsLengthClearanceAndTime) {
  const DrawnHost host(DrawnMap(1.0, {R"(
    #######
    #a...b#
    #######
    #c#####)"}));
  karst_request_t r{};
  r.size = sizeof r;
  r.map = host.map_handle();
  const karst::Request request(host.host(), r);
  const auto place = [&](char letter) { return host.map().place(letter); };
  const std::vector<karst::Path> paths = request.paths(place('a'), {place('b'), place('c'), place('a')});
  ASSERT_EQ(paths.size(), 3u);
  ASSERT_EQ(paths[0].points.size(), 5u);
  EXPECT_EQ(paths[0].points.front().x, place('a').x);
  EXPECT_EQ(paths[0].points.back().x, place('b').x);
  EXPECT_NEAR(paths[0].length_m, 4, 1e-9);
  EXPECT_NEAR(paths[0].clearance_m, 1, 1e-9) << "a passage of one cell";
  EXPECT_NEAR(paths[0].time_s, 4 / 1.6 + 0.8, 1e-9);
  EXPECT_FALSE(paths[1].known());
  EXPECT_TRUE(std::isinf(paths[1].length_m));
  EXPECT_EQ(paths[2].length_m, 0);
}

TEST(DrawnHost, RockIsWhatIsOccupied) {
  const DrawnHost host(DrawnMap(1.0, {"a...#???"}));
  karst_request_t r{};
  r.size = sizeof r;
  r.map = host.map_handle();
  const karst::Request request(host.host(), r);
  const karst::Vec3 a = host.map().place('a');
  EXPECT_EQ(request.map.distances_to_rock({a, {3.25, 0.5, 0.5}}, 10), (std::vector<double>{4, 1.25}));
  EXPECT_EQ(request.map.distances_to_rock({a}, 3), std::vector<double>{3}) << "unknown cells are no rock";
  EXPECT_THROW(request.map.distances_to_rock({a}, 0), karst::Error);
}

DrawnMap forked_plan() {
  return {1.0, {R"(
    #########################
    #############.###########
    #############.###########
    #############.###########
    #############.###########
    #############.###########
    #############.###########
    #############.###########
    #############b###########
    #############.###########
    #############.###########
    #s....a.................?
    #########################)"}};
}

TEST(DrawnHost, PassagesAreThoseOfTheDrawing) {
  DrawnHost host(forked_plan());
  host.start = host.map().place('s');
  karst_request_t r{};
  r.size = sizeof r;
  r.map = host.map_handle();
  const karst::Request request(host.host(), r);
  const karst::Passages found = request.map.passages();
  ASSERT_EQ(found.ends.size(), 4u);
  ASSERT_EQ(found.passages.size(), 3u);
  EXPECT_EQ(found.ends[0].kind, karst_passage_end_kind_t{KARST_PASSAGE_DEAD_END});
  EXPECT_EQ(distance(found.ends[0].position, host.map().place('s')), 0)
      << "the nearest to the start is first";
  EXPECT_TRUE(found.ends[1].is_junction());
  EXPECT_EQ(found.ends[1].ways, 3u);
  EXPECT_NEAR(found.ends[1].position.x, 13.5, 1);
  EXPECT_EQ(found.ends[2].kind, karst_passage_end_kind_t{KARST_PASSAGE_DEAD_END});
  EXPECT_TRUE(found.ends[3].is_open());
  EXPECT_EQ(found.ends[3].frontier_m2, 1) << "one cell, seen from the side: it is a plan";
  for (const karst::Passage& p : found.passages) {
    EXPECT_TRUE(p.from == 1 || p.to == 1) << "all lead to the junction";
    EXPECT_NEAR(p.least_width_m, 1, 1e-6);
    EXPECT_NEAR(p.mean_height_m, 1, 1e-6);
  }
  const auto places = request.map.passages_at({host.map().place('a'), host.map().place('b'), {50, 50, 50}});
  EXPECT_EQ(places[0].passage, 0u);
  EXPECT_NEAR(places[0].from_start_m, 5, 1);
  EXPECT_EQ(places[0].junction, karst::PassagePlace::none);
  EXPECT_EQ(places[1].passage, 1u);
  EXPECT_EQ(places[2].passage, karst::PassagePlace::none);
  EXPECT_EQ(places[2].junction, karst::PassagePlace::none);
  host.start = {100, 100, 0};
  EXPECT_TRUE(request.map.passages().passages.empty()) << "no free cell is near the start";
}

/// Flies to the open end of a passage that is nearest along the passages, and says how wide the way to it is.
class Speleologist : public karst::Policy {
  Decision decide(const karst::Request& r) override {
    const karst::Passages found = r.map.passages();
    for (const karst::Passage& p : found.passages)
      if (found.ends[p.to].is_open()) {
        karst::Goal g;
        g.position = found.ends[p.to].position;
        g.why = std::to_string(p.least_width_m);
        return Decision::fly({g});
      }
    return Decision::explored("no passage leads on");
  }
};

TEST(Bench, PassagesAreFoundFromTheBenchesStart) {
  static const auto policy = [](std::uint32_t) noexcept {
    return karst::border::entry<Speleologist>("speleologist", "1.0.0", "Follows passages.");
  };
  static const karst_plugin_t plugin{sizeof plugin, KARST_ABI_MAJOR, KARST_ABI_MINOR, 1, policy};
  Bench bench(&plugin, forked_plan());
  bench.start = bench.position = bench.host().map().place('s');
  const Decision d = bench.decide();
  ASSERT_EQ(d.goals.size(), 1u);
  EXPECT_NEAR(d.goals[0].position.x, 23, 1.6);
  EXPECT_EQ(std::stod(d.goals[0].why), 1);
  bench.start = {100, 100, 0};
  EXPECT_EQ(bench.decide().outcome, karst_outcome_t{KARST_OUTCOME_EXPLORED});
}

TEST(MapView, OfAHostWithoutPassagesThrows) {
  const DrawnHost host(forked_plan());
  karst_host_t older = *host.host();
  karst_map_service_t map = *older.map;
  map.size = offsetof(karst_map_service_t, passages);
  older.map = &map;
  const karst::MapView view(&older, host.map_handle());
  EXPECT_THROW(view.passages(), karst::Error);
  try {
    view.passages_at({{0, 0, 0}});
    ADD_FAILURE() << "answered";
  } catch (const karst::Error& e) {
    EXPECT_EQ(e.code(), KARST_ERROR_UNAVAILABLE);
  }
}

DrawnMap crossing() {
  return {1.0, {R"(
    ###?###
    ###.###
    ?a.s...
    #######)"}};
}

TEST(DrawnFrontiers, AreFreeCellsNextToTheUnknownInGroupsThatTouch) {
  const DrawnMap map = crossing();
  const std::vector<karst::Frontier> found = find_frontiers(map, map.place('s'));
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(distance(found[0].viewpoint, map.place('a')), 0.0);
  EXPECT_NEAR(found[0].viewpoint_heading_rad, 3.14159265, 1e-6) << "west";
  EXPECT_NEAR(found[1].normal.y, 1.0, 1e-9) << "north";
  EXPECT_NEAR(found[2].path_length_m, 3.0, 1e-9);
  EXPECT_EQ(find_frontiers(map, map.place('s'), 2).size(), 0u) << "each is a single cell";
}

/// The nearest frontier that has not failed.
class Simple : public karst::Policy {
  Decision decide(const karst::Request& r) override {
    const karst::Frontier* best = nullptr;
    for (const karst::Frontier& f : r.frontiers)
      if (f.id != failed_ && (best == nullptr || f.path_length_m < best->path_length_m)) best = &f;
    if (best == nullptr) return Decision::explored("nothing left");
    return Decision::fly({karst::goal_at(*best, -best->path_length_m, "nearest")});
  }
  void on_event(const karst::Event& e) override {
    if (e.kind == KARST_EVENT_GOAL_UNREACHABLE) failed_ = e.goal.frontier_id;
  }
  std::uint32_t failed_ = 0;
};
const karst_plugin_t* plugin() {
  static const auto policy = [](std::uint32_t) noexcept {
    return karst::border::entry<Simple>("simple", "1.0.0", "Simple.");
  };
  static const karst_plugin_t p{sizeof(karst_plugin_t), KARST_ABI_MAJOR, KARST_ABI_MINOR, 1, policy};
  return &p;
}

TEST(Script, PlaysRequestsAndEventsInTurn) {
  Bench bench(plugin(), crossing());
  bench.position = bench.host().map().place('s');
  bench.offer_drawn();
  EXPECT_EQ(
      play(bench, {{"at the start", {}, flies_to_frontier(2) && gives_reason("nearest")},
                   {"no way", [](Bench& b) { b.fail(KARST_EVENT_GOAL_UNREACHABLE); }, flies_to_frontier(1)},
                   {"there", [](Bench& b) { b.arrive(); }, flies_to_frontier(1)},
                   {"all seen", [](Bench& b) { b.frontiers.clear(); }, has_explored()}}),
      "");
  EXPECT_EQ(bench.time_s, 4.0);
}

TEST(Script, SaysWhichStepFailedWithTheWholeAnswer) {
  Bench bench(plugin(), crossing());
  bench.position = bench.host().map().place('s');
  bench.offer_drawn();
  const std::string fault = play(bench, {{"at the start", {}, flies_to_frontier(2)}, {"again", {}, holds()}});
  EXPECT_EQ(
      fault,
      "step 2, again\nexpected: holds\ngot: goals\n  1. (3.5, 2.5, 0.5), frontier 2, score -1: nearest");
}

TEST(Expectations, HoldForWhatTheySayAndNotForElse) {
  karst::Goal g;
  g.position = {1, 2, 3};
  g.frontier_id = 7;
  const Decision fly = Decision::fly({g}), hold = Decision::hold("wait"), home = Decision::go_home("late");
  EXPECT_EQ(mismatch(fly, flies_to({1, 2, 3.4})), "");
  EXPECT_NE(mismatch(fly, flies_to({1, 2, 3.6})), "");
  EXPECT_EQ(mismatch(fly, offers_frontiers({7})), "");
  EXPECT_NE(mismatch(fly, offers_frontiers({7, 8})), "");
  EXPECT_NE(mismatch(fly, avoids_frontier(7)), "");
  EXPECT_EQ(mismatch(hold, holds() && gives_reason("wai")), "");
  EXPECT_NE(mismatch(hold, goes_home()), "");
  EXPECT_EQ(mismatch(home, goes_home() && is_well_formed()), "");
  g.score = std::numeric_limits<double>::infinity();
  EXPECT_NE(mismatch(Decision::fly({g}), is_well_formed()), "");
  EXPECT_NE(mismatch(Decision::fly({}), is_well_formed()), "");
}

}  // namespace
