// Flights within a region, judged by the simulator's truth.
#include <boost/property_tree/ptree.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core_stack/common/options.h"
#include "core_stack/mapping/region/region_keys.h"
#include "sdk/evaluation/record/poses.h"
#include "tests/closed_loop/command.h"
#include "tests/closed_loop/drawn_cave.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

constexpr double kRadius_m = 0.3;  // of the simulated vehicle's hull

struct Flown {
  Output out;
  fs::path run;
  std::string events;
  nlohmann::json metrics;
  std::vector<core::Vec3> truth;
  double depth_m = 0;  // the least of the hull: negative outside
  bool says(const std::string& part) const { return events.find(part) != std::string::npos; }
};

Flown fly(const std::string& name, const std::string& cave, const std::string& keys) {
  Flown f;
  f.run = fresh_folder("region_" + name) / "run";
  // Between smooth walls LOAM loses its way; the estimate is not what is tested here.
  f.out = run_karst(
      "fly --cave " + cave +
      " --set simulator.pose.fitted=always --set localization.source=pose_sensor --quiet --no-report --out " +
      f.run.string() + " " + keys);
  if (!fs::exists(f.run / "mission.info")) return f;
  f.events = bytes_of(f.run / "events.jsonl");
  f.metrics = nlohmann::json::parse(bytes_of(f.run / "metrics.json"));
  std::vector<std::string> problems;
  for (const auto& pose : evaluation::read_tum(f.run / "ground_truth.tum", problems))
    f.truth.push_back(pose.T_world_body.position);
  const auto region = core::region_in("mission.info", core::read_info((f.run / "mission.info").string()));
  f.depth_m = 1e9;
  if (region)
    for (const core::Vec3& p : f.truth) f.depth_m = std::min(f.depth_m, region->depth_m(p) - kRadius_m);
  return f;
}

void expect_kept(const Flown& f) {
  EXPECT_EQ(f.out.code, 0) << f.out.text;
  ASSERT_FALSE(f.truth.empty()) << f.out.text;
  EXPECT_GT(f.depth_m, 0) << "the hull left the region";
  EXPECT_EQ(f.metrics["outcome"], "landed");
  EXPECT_GT(f.metrics["min_clearance_m"].get<double>(), 0);
  EXPECT_FALSE(f.says("is outside region"));
}

double farthest_x(const Flown& f) {
  double x = -1e9;
  for (const core::Vec3& p : f.truth) x = std::max(x, p.x());
  return x;
}

TEST(RegionFlight, InABoxItExploresTheBoxAndEndsAsExplored) {
  const std::string cave = passage_cave(fresh_folder("region_box_cave"));
  const Flown f =
      fly("box", cave, "--set 'region.keep_in=box -6 -6 -2 18 6 6' --set mission.max_flight_time=120s");
  expect_kept(f);
  EXPECT_TRUE(f.says("explored"));
  EXPECT_GT(farthest_x(f), 12);                             // it goes up to the border
  EXPECT_GT(f.metrics["coverage"].get<double>(), 0.97);     // of what lies inside
  EXPECT_GT(f.metrics["explored_volume_m3"].get<double>(),  // and maps what it sees beyond
            1.2 * f.metrics["reachable_volume_m3"].get<double>());
}

TEST(RegionFlight, APolygonWithHeightsHoldsInAShaft) {
  const std::string cave = draw_cave(fresh_folder("region_shaft_cave"),
                                     {{{-5, -5, 0}, {5, 5, 20}}, {{4, -2, 0}, {16, 2, 3}}}, {0, 0, 1});
  const Flown f = fly("shaft", cave,
                      "--set 'region.keep_in=polygon -8 -8 9 -8 9 8 2 8 -8 4 from -2 to 6' "
                      "--set mission.max_flight_time=90s");
  expect_kept(f);
  double highest = 0;
  for (const core::Vec3& p : f.truth) highest = std::max(highest, p.z());
  EXPECT_LT(highest, 6 - kRadius_m);
}

TEST(RegionFlight, APassageToKeepOutOfAtAJunctionIsNotEntered) {
  // West to east, with a side passage to the north at x = 12.
  const std::string cave = draw_cave(fresh_folder("region_junction_cave"),
                                     {{{-4, -3, 0}, {26, 3, 3}}, {{9, 2, 0}, {15, 24, 3}}}, {0, 0, 1});
  const Flown f = fly("junction", cave,
                      "--set 'region.keep_out=box 8 5 -1 16 30 5 | box 22 -4 -1 30 4 5' "
                      "--set mission.max_flight_time=100s");
  expect_kept(f);
  EXPECT_GT(f.metrics["coverage"].get<double>(), 0.97);  // of what lies inside, behind the junction as well
  for (const core::Vec3& p : f.truth) EXPECT_LT(p.y(), 5 - kRadius_m);
}

TEST(RegionFlight, ItFliesNoFartherFromHomeThanAllowed) {
  const std::string cave = passage_cave(fresh_folder("region_distance_cave"));
  const Flown f =
      fly("distance", cave, "--set region.max_home_distance=15 --set mission.max_flight_time=100s");
  expect_kept(f);
  // From there it has seen all that it may fly to: how near to the limit that is, its goals decide.
  EXPECT_GT(farthest_x(f), 7.5);
  EXPECT_GT(f.metrics["coverage"].get<double>(), 0.97);
  EXPECT_LT(farthest_x(f), 15.5);  // the passage is straight so far, and the way home as long as x
  EXPECT_TRUE(f.says("explored"));
}

TEST(RegionFlight, WindAtTheBorderDoesNotBlowItOut) {
  const std::string cave = passage_cave(fresh_folder("region_wind_cave"));
  const Flown f = fly("wind", cave,
                      "--set 'region.keep_in=box -6 -6 -2 14 6 6' --set simulator.draught_east=4 "
                      "--set simulator.gust=1.5 --set mission.max_flight_time=80s");
  expect_kept(f);
  EXPECT_GT(farthest_x(f), 9);
}

TEST(RegionFlight, ARecedingHorizonKeepsToIt) {
  const std::string cave = passage_cave(fresh_folder("region_horizon_cave"));
  const Flown f = fly("horizon", cave,
                      "--set 'region.keep_in=box -6 -6 -2 18 6 6' --set motion.trajectory=horizon "
                      "--set mission.max_flight_time=45s");
  expect_kept(f);
}

TEST(RegionFlight, ABadRegionIsRefusedBeforeTakeOff) {
  const std::string cave = passage_cave(fresh_folder("region_bad_cave"));
  for (const auto& [keys, reason] : std::vector<std::pair<std::string, std::string>>{
           {"'region.keep_in=box 5 -6 -2 18 6 6'", "region.keep_in: leaves no room for the vehicle's start"},
           {"'region.keep_in=box -6 -6 -2 18 6 1.2'", "region.keep_in: leaves no room for the take-off"},
           {"'region.keep_in=box -6 -6 -2 18 6 2.2'", "region.keep_in: leaves no room for the first hover"},
           {"'region.keep_out=box -1 -1 2 1 1 4'", "number 1 of region.keep_out: leaves no room for"},
           {"'region.keep_in=polygon 0 0 1 1 1 0 0 1'", "region.keep_in: its edge from (0, 0)"},
           {"'region.keep_in=box 0 0 0 1 1 0'", "is not below its highest"}}) {
    const Flown f = fly("bad", cave, "--set " + keys);
    EXPECT_EQ(f.out.code, 1) << f.out.text;
    std::string one_line = f.out.text;  // long reasons are wrapped
    std::replace(one_line.begin(), one_line.end(), '\n', ' ');
    while (one_line.find("  ") != std::string::npos) one_line.erase(one_line.find("  "), 1);
    EXPECT_NE(one_line.find(reason), std::string::npos) << f.out.text;
    EXPECT_FALSE(fs::exists(f.run / "events.jsonl"));
  }
}

}  // namespace
}  // namespace karst
