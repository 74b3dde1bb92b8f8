#include "core_stack/mission/world_model/world_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/mission/mapped_world.h"

namespace karst::core {
namespace {

const Vec3 kHere(3, 3, 1.4), kInside(7.5, 2.9, 1.3), kBeyond(12, 3, 1.4);

WorldModel mapped(const VoxelMap& map, const CoreOptions& options = {}) {
  WorldModel world(options, lidar_vehicle_at_start());
  world.integrate(rays_of(map));
  return world;
}

TEST(WorldModel, TakesRaysIntoTheMapAndItsFrontiers) {
  const WorldModel world = mapped(room_open_to_x());
  std::size_t frontier_cells = 0;
  world.map().for_each_known([&](const CellKey& k, Cell cell, float) {
    bool beside_unknown = false;
    for (const CellKey& d : {CellKey{1, 0, 0}, CellKey{-1, 0, 0}, CellKey{0, 1, 0}, CellKey{0, -1, 0},
                             CellKey{0, 0, 1}, CellKey{0, 0, -1}})
      beside_unknown = beside_unknown || world.map().at(k + d) == Cell::unknown;
    frontier_cells += cell == Cell::free && beside_unknown;
  });
  EXPECT_GT(frontier_cells, 100u);
  EXPECT_EQ(world.frontiers().cell_count(), frontier_cells);
}

CoreOptions within(const FlightRegion::Limits& limits) {
  CoreOptions options;
  options.region = std::make_shared<const FlightRegion>(limits);
  return options;
}

TEST(WorldModel, PlansNothingOutOfTheRegionButMapsIt) {
  FlightRegion::Limits limits;
  limits.keep_in = box({-1, -1, -1}, {6, 9, 9});
  limits.margin_m = 0.5;
  WorldModel world = mapped(room_open_to_x(), within(limits));
  EXPECT_EQ(world.map().free_cells(), mapped(room_open_to_x()).map().free_cells());
  EXPECT_EQ(world.frontiers().cell_count(), 0u);  // the open side lies outside
  const Path out = world.plan(world.usual(), kHere, {7, 3, 1.4});
  EXPECT_EQ(out.status, PlanStatus::goal_blocked);
  EXPECT_NE(out.reason.find("outside region.keep_in"), std::string::npos) << out.reason;
  EXPECT_TRUE(world.plan(world.usual(), kHere, {4.5, 3, 1.4}).found());
}

TEST(WorldModel, PlansNoPathFartherFromHomeThanAllowed) {
  VoxelMap hall{MapOptions{}};
  carve_box(hall, Vec3(0, 0, 0), Vec3(30, 6, 4));
  FlightRegion::Limits limits;
  limits.max_home_m = 12;
  WorldModel world = mapped(hall, within(limits));
  world.set_home(kHere);
  EXPECT_TRUE(world.plan(world.usual(), kHere, {13, 3, 1.4}).found());
  const Path far = world.plan(world.usual(), kHere, {17, 3, 1.4});
  EXPECT_FALSE(far.found());
  EXPECT_NE(far.reason.find("region.max_home_distance"), std::string::npos);
  EXPECT_FALSE(world.too_far_from_home(world.usual(), {14, 3, 1.4}));
  EXPECT_TRUE(world.too_far_from_home(world.usual(), {16, 3, 1.4}));
  // From beyond, home is near enough, and so is what lies nearer to it.
  EXPECT_TRUE(world.plan(world.usual(), {20, 3, 1.4}, kHere).found());
  EXPECT_TRUE(world.plan(world.usual(), {20, 3, 1.4}, {12, 3, 1.4}).found());
}

TEST(WorldModel, CountsWhatTheSurveyLacksWhetherThePolicyIsToldOrNot) {
  EXPECT_FALSE(mapped(room_open_to_x()).unsurveyed_m3());
  const PassageSize size{1, 1, 1, 1};
  CoreOptions options;
  options.survey.passages =
      std::make_shared<const SurveyedPassages>(SurveyPrior{{{0, 3, 2}, {4, 3, 2}}, {{0, 1, size, size}}, {}});
  for (const bool told : {true, false}) {
    options.survey.told_to_policy = told;
    const WorldModel world = mapped(room_open_to_x(), options);
    double expected_m3 = 0;
    world.map().for_each_known([&](const CellKey& k, Cell cell, float) {
      const bool lacked = options.survey.passages->distance_m(world.map().center_of(k)) > kBeyondSurvey_m;
      if (cell == Cell::free && lacked) expected_m3 += std::pow(world.map().resolution_m(), 3);
    });
    EXPECT_GT(expected_m3, 1);
    EXPECT_LT(expected_m3, world.map().free_volume_m3());
    EXPECT_NEAR(world.unsurveyed_m3().value_or(-1), expected_m3, 1e-6);
    EXPECT_EQ(world.survey(), told ? options.survey.passages.get() : nullptr);
  }
}

TEST(WorldModel, DeclaresTheLaunchSiteFree) {
  CoreOptions options;
  options.mission.launch_clear_radius_m = 0.9;
  WorldModel world(options, lidar_vehicle_at_start());
  EXPECT_FALSE(world.declare_launch_site(world.home()).empty());
  EXPECT_EQ(world.home(), Vec3(3, 3, 1 + options.mission.takeoff_height_m));
  // Half a cell's diagonal to either side of the ball's surface.
  for (double r = 0; r < 2; r += 0.1) {
    const Cell cell = world.map().at(Vec3(world.home() + Vec3(r, 0, 0)));
    if (std::abs(r - 0.9) > 0.18) {
      EXPECT_EQ(cell, r < 0.9 ? Cell::free : Cell::unknown) << r;
    }
  }
  EXPECT_GT(world.frontiers().cell_count(), 0u);
}

TEST(WorldModel, ItsRoadmapKnowsTheWayToWhereHomeIsNow) {
  WorldModel world = mapped(room_open_to_x());
  world.set_home(Vec3(1, 3, 2));
  const Vec3 from(7, 3, 2);
  EXPECT_NEAR(world.usual().home_length_m(world.map(), from).value_or(0), 6, 0.6);
  world.set_home(Vec3(4, 3, 2));
  EXPECT_NEAR(world.usual().home_length_m(world.map(), from).value_or(0), 3, 0.6);
  // A wall across the room.
  VoxelMap wall{MapOptions{}};
  const CellKey a = wall.key_of(Vec3(5.1, 0.1, 0.1)), b = wall.key_of(Vec3(5.1, 5.9, 3.9));
  for (int y = a.y; y <= b.y; ++y)
    for (int z = a.z; z <= b.z; ++z) wall.assign({a.x, y, z}, 1, 1.0f);
  for (int i = 0; i < 3; ++i) world.integrate(rays_of(wall));
  EXPECT_FALSE(world.usual().home_length_m(world.map(), from));
}

TEST(WorldModel, FliesNarrowPassagesOnlyIfAllowedAndIfThereIsNoOtherPath) {
  const VoxelMap map = rooms_with_a_narrow_corridor();
  WorldModel usual_only = mapped(map);
  EXPECT_FALSE(usual_only.plan_to(kHere, kBeyond).found());
  EXPECT_EQ(usual_only.narrow(), nullptr);

  WorldModel world = mapped(map, narrow_passages_allowed());
  EXPECT_TRUE(world.plan_to(kHere, Vec3(1, 1, 1.4)).found());
  EXPECT_EQ(world.narrow_if_made(), nullptr) << "nobody has needed it";
  const Path path = world.plan_to(kHere, kBeyond);
  ASSERT_TRUE(path.found()) << path.reason;
  EXPECT_TRUE(path.narrow());
  for (std::size_t i = 1; i < path.points.size(); ++i)
    EXPECT_TRUE(segment_clear(world.map(), path.points[i - 1], path.points[i], 0.3));
  EXPECT_NE(world.narrow_if_made(), nullptr);
}

TEST(WorldModel, InsideANarrowPassagePlansAlongIt) {
  WorldModel world = mapped(rooms_with_a_narrow_corridor(), narrow_passages_allowed());
  EXPECT_EQ(world.roadmap_at(kInside).passages(), Passages::usual) << "the narrow one is not made yet";
  ASSERT_NE(world.narrow(), nullptr);
  EXPECT_EQ(world.roadmap_at(kInside).passages(), Passages::narrow);
  EXPECT_EQ(world.roadmap_at(kHere).passages(), Passages::usual);
}

TEST(WorldModel, BothRoadmapsHearOfChanges) {
  WorldModel world = mapped(rooms_with_a_narrow_corridor(), narrow_passages_allowed());
  ASSERT_TRUE(world.plan(*world.narrow(), kHere, kBeyond).found());
  VoxelMap plug{MapOptions{}};
  carve_box(plug, Vec3(7.4, 2.2, 0.4), Vec3(7.8, 3.6, 2.4));  // two cells thick: all of them walls
  for (int i = 0; i < 3; ++i) world.integrate(rays_of(plug));
  EXPECT_FALSE(world.plan(*world.narrow(), kHere, kBeyond).found());
  EXPECT_FALSE(world.narrow()->home_length_m(world.map(), kBeyond));
}

TEST(WorldModel, MeasuresTheNarrowPartOfAPath) {
  WorldModel world = mapped(rooms_with_a_narrow_corridor(), narrow_passages_allowed());
  world.usual();
  Path path;
  for (double x = 3; x < 12; x += 0.05) path.points.push_back(Vec3(x, 2.9, 1.3));
  // The corridor is 3 m long; by the usual clearance the rooms end 0.6 m before it, and 0.8 m beside what is
  // clear by that still counts as wide.
  EXPECT_NEAR(world.narrow_length_m(path), 3 + 2 * 0.6 - 2 * 0.8, 0.5);
  path.points.resize(20);
  EXPECT_EQ(world.narrow_length_m(path), 0);
}

TEST(WorldModel, KeepsWhatTheColourCameraHasImaged) {
  WorldModel blind = mapped(room_open_to_x());
  EXPECT_EQ(blind.imaged(), nullptr);
  VehicleDescription vehicle = lidar_vehicle_at_start();
  auto rgb = std::make_shared<RgbCameraModel>();
  rgb->camera.horizontal_fov_rad = rgb->camera.vertical_fov_rad = 1.0;
  rgb->camera.max_range_m = 10;
  vehicle.rgb = rgb;
  WorldModel world({}, vehicle);
  world.integrate(rays_of(room_open_to_x()));
  ASSERT_NE(world.imaged(), nullptr);
  EXPECT_EQ(world.imaged()->size(), 0u);
  Pose T_world_camera;
  T_world_camera.position = Vec3(3, 3, 2);
  T_world_camera.orientation = from_heading(std::acos(-1.0));  // towards the wall x = 0
  world.note_picture(T_world_camera);
  EXPECT_TRUE(world.imaged()->contains(world.map().key_of(Vec3(0.1, 3.1, 2.1))));
  EXPECT_FALSE(world.imaged()->contains(world.map().key_of(Vec3(3.1, 5.9, 2.1)))) << "to its side";
}

}  // namespace
}  // namespace karst::core
