#include "core_stack/planning/search/ompl_search.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thread>

#include "core_stack/common/error.h"
#include "core_stack/planning/planner.h"
#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/planning/oracles.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using testing::all_cells;
using testing::Obstacles;
using testing::WindingCave;

PlanningOptions with(Planner planner) {
  PlanningOptions options{.clearance_m = 0.45};
  options.planner = planner;
  options.planner_iterations = 1500;
  return options;
}

struct Winding {
  WindingCave cave = WindingCave::of_length(18, 4, 1.5);
  VoxelMap map = cave.map();
  Roadmap roadmap{with(Planner::grid)};
  Vec3 a = cave.line[4], b = cave.line[31];
  Winding() { roadmap.update(map, all_cells(map)); }
};

const std::vector kPlanners{Planner::grid, Planner::rrt_connect, Planner::rrt_star, Planner::bit_star};

TEST(OmplSearch, EveryPlannersPathIsClearAndJoinsTheEnds) {
  const Winding w;
  const Obstacles obstacles(w.map);
  for (const Planner planner : kPlanners) {
    const Path raw = search_with_ompl(w.map, w.roadmap, w.a, w.b, with(planner), 0.45);
    ASSERT_TRUE(raw.found()) << name_of(planner) << ": " << raw.reason;
    const Path path = plan(w.map, w.roadmap, w.a, w.b, with(planner));
    ASSERT_TRUE(path.found()) << name_of(planner) << ": " << path.reason;
    for (const Path& p : {raw, path}) {
      EXPECT_EQ(p.points.front(), w.a);
      EXPECT_EQ(p.points.back(), w.b);
      EXPECT_EQ(p.escape_points, 0u);
      for (std::size_t k = 1; k < p.points.size(); ++k)
        EXPECT_GE(obstacles.distance(p.points[k - 1], p.points[k]), 0.45 - 1e-6) << name_of(planner);
    }
  }
}

TEST(OmplSearch, AQueryGivesTheSamePathWhateverWasAskedBeforeAndMeanwhile) {
  const Winding w;
  for (const Planner planner : kPlanners) {
    const auto ask = [&] { return search_with_ompl(w.map, w.roadmap, w.a, w.b, with(planner), 0.45).points; };
    const std::vector<Vec3> first = ask();
    for (const Planner other : kPlanners)
      search_with_ompl(w.map, w.roadmap, w.b, w.cave.line[6], with(other), 0.45);
    EXPECT_EQ(ask(), first) << name_of(planner);
    std::vector<Vec3> one, two;
    std::thread t([&] { one = ask(); });
    two = ask();
    t.join();
    EXPECT_EQ(one, first) << name_of(planner);
    EXPECT_EQ(two, first) << name_of(planner);
  }
}

TEST(OmplSearch, TheGridPlannerBehindOmplsInterfaceFindsWhatItFindsAlone) {
  const Winding w;
  EXPECT_EQ(search_with_ompl(w.map, w.roadmap, w.a, w.b, with(Planner::grid), 0.45).points,
            plan_on_grid(w.map, w.a, w.b, with(Planner::grid)).points);
}

TEST(OmplSearch, NothingIsPrinted) {
  const Winding w;
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  for (const Planner planner : kPlanners) search_with_ompl(w.map, w.roadmap, w.a, w.b, with(planner), 0.45);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(OmplSearch, SaysWhyThereIsNoPath) {
  const Winding w;
  for (const Planner planner : kPlanners) {
    const Path none = search_with_ompl(w.map, w.roadmap, w.a, {0, 0, 50}, with(planner), 0.45);
    EXPECT_EQ(none.status, PlanStatus::goal_blocked) << name_of(planner);
    EXPECT_FALSE(none.reason.empty()) << name_of(planner);
  }
  PlanningOptions hasty = with(Planner::rrt_star);
  hasty.planner_iterations = 1;
  const Path none = search_with_ompl(w.map, w.roadmap, w.a, w.b, hasty, 0.45);
  EXPECT_EQ(none.status, PlanStatus::gave_up);
  EXPECT_NE(none.reason.find("rrt_star"), std::string::npos);
}

TEST(PlanningOptions, AnUnknownPlannerIsRefusedWithTheNearestName) {
  PlanningOptions options;
  OptionTable table;
  table.section("planning", options);
  table.set("mission", "planning.planner", "bit_star");
  EXPECT_EQ(options.planner, Planner::bit_star);
  try {
    table.set("mission", "planning.planner", "rrt_conect");
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("rrt_connect"), std::string::npos) << e.what();
  }
}

TEST(LengthBound, HoldsAgainstDijkstra) {
  int found = 0;
  rc::check("bound", [&] {
    Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
    const CellKey size{14, 12, 8};
    const VoxelMap map = testing::random_map(random.bits(), size, 0.006);
    const Obstacles obstacles(map);
    const auto cell = [&] {
      return CellKey{static_cast<std::int32_t>(3 + random.bits() % 8),
                     static_cast<std::int32_t>(3 + random.bits() % 6),
                     static_cast<std::int32_t>(3 + random.bits() % 2)};
    };
    const CellKey from = cell(), to = cell();
    PlanningOptions options{.clearance_m = 0.45};
    options.heuristic_weight = 1.0 + random.uniform(0, 2);
    const Path path = plan_on_grid(map, map.center_of(from), map.center_of(to), options);
    const std::optional<double> best = testing::dijkstra_m(map, obstacles, size, from, to, 0.45);
    if (!path.found() || !best || from == to) return;
    ++found;
    RC_ASSERT(path.length_bound <= options.heuristic_weight + 1e-9 || path.escape_points > 0);
    RC_ASSERT(path.length_m <= path.length_bound * *best + 1e-4);
  });
  EXPECT_GT(found, 5);
}

}  // namespace
}  // namespace karst::core
