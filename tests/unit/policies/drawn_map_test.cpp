#include <gtest/gtest.h>

#include <karst/policy.h>
#include <karst/testing/drawn_host.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using karst::Cell;
using karst::Vec3;
using karst::testing::DrawnHost;
using karst::testing::DrawnMap;
using karst::testing::Index;

TEST(DrawnMap, FirstRowIsNorthAndLayersGoUp) {
  const DrawnMap map(0.5, {R"(
    #a
    .?)",
                           "b"});
  EXPECT_EQ(map.at(Index{0, 1, 0}), Cell::occupied);
  EXPECT_EQ(map.at(Index{1, 1, 0}), Cell::free);
  EXPECT_EQ(map.at(Index{1, 0, 0}), Cell::unknown);
  EXPECT_EQ(map.at(Index{0, 0, 1}), Cell::free);
  EXPECT_EQ(map.at(Index{-1, 0, 0}), Cell::unknown);
  EXPECT_DOUBLE_EQ(map.place('a').x, 0.75);
  EXPECT_DOUBLE_EQ(map.place('a').y, 0.75);
  EXPECT_DOUBLE_EQ(map.place('b').z, 0.75);
}

TEST(DrawnMap, RefusesAnUnknownSignAndAnUnknownName) {
  EXPECT_THROW(DrawnMap(1.0, {"a$b"}), std::invalid_argument);
  EXPECT_THROW(DrawnMap(1.0, {"a"}).place('z'), std::out_of_range);
}

TEST(DrawnMap, PathGoesRoundTheWall) {
  const DrawnMap map(1.0, {R"(
    ...
    a#b
    ###)"});
  EXPECT_NEAR(map.path_length_m(map.place('a'), map.place('b')), 2 * std::sqrt(2.0), 1e-12);
  const DrawnMap closed(1.0, {"a#b"});
  EXPECT_EQ(closed.path_length_m(closed.place('a'), closed.place('b')), HUGE_VAL);
}

TEST(DrawnHost, RaysStopWhereTheyShould) {
  DrawnHost host(DrawnMap(1.0, {"a..?#"}));
  const karst::MapView view(host.host(), host.map_handle());
  const karst_segment_t ray{{0.5, 0.5, 0.5}, {10, 0.5, 0.5}};
  EXPECT_EQ(view.cast({ray}, false)[0].state, karst_cell_t{KARST_CELL_UNKNOWN});
  EXPECT_DOUBLE_EQ(view.cast({ray}, false)[0].length_m, 3.0);
  EXPECT_EQ(view.cast({ray}, true)[0].state, karst_cell_t{KARST_CELL_OCCUPIED});
  EXPECT_DOUBLE_EQ(view.cast({ray}, true)[0].length_m, 4.0);
}

TEST(DrawnMap, BoundsHoldAllThatIsKnown) {
  const DrawnMap map(0.5, {"??#", "?.?"});
  EXPECT_DOUBLE_EQ(map.bounds().low.x, 0.5);
  EXPECT_DOUBLE_EQ(map.bounds().high.x, 1.5);
  EXPECT_DOUBLE_EQ(map.bounds().low.z, 0.0);
  EXPECT_DOUBLE_EQ(map.bounds().high.z, 1.0);
}

/// As a ray is defined: every hundredth of a cell is looked at.
karst_ray_end_t step_by_step(const DrawnMap& map, const karst_segment_t& ray, bool through_unknown) {
  const Vec3 from = ray.from, to = ray.to;
  const int steps = static_cast<int>(std::ceil(distance(from, to) / (0.01 * map.resolution_m())));
  karst_ray_end_t end{};
  for (int i = 0; i <= steps; ++i) {
    const Vec3 p = from + (steps == 0 ? 0.0 : static_cast<double>(i) / steps) * (to - from);
    const Cell c = map.at(p);
    end.center = map.center_of(map.index_of(p));
    end.state = static_cast<karst_cell_t>(c);
    if (c == Cell::occupied || (c == Cell::unknown && !through_unknown)) return end;
  }
  end.state = static_cast<karst_cell_t>(Cell::free);
  return end;
}

TEST(DrawnHost, LeavingStepsOutChangesNoRay) {
  std::mt19937 chance(5);
  std::uniform_int_distribution<int> tenth(0, 9), coordinate(-8, 48);
  DrawnMap map(0.5, {});
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y)
      for (int z = 0; z < 10; ++z)
        if (const int t = tenth(chance); t > 0) map.set({x, y, z}, t == 1 ? Cell::occupied : Cell::free);
  std::vector<karst_segment_t> rays;
  for (int i = 0; i < 300; ++i) {
    // Quarters of a metre: many begin and end on the faces, edges and corners of cells.
    const auto place = [&] {
      return Vec3(0.25 * coordinate(chance), 0.25 * coordinate(chance), 0.25 * coordinate(chance));
    };
    rays.push_back({place(), place()});
    if (i % 3 == 0) rays.back().to.y = rays.back().from.y;  // along a plane of the grid
  }
  DrawnHost host(map);
  const karst::MapView view(host.host(), host.map_handle());
  for (const bool through_unknown : {false, true}) {
    const std::vector<karst_ray_end_t> ends = view.cast(rays, through_unknown);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const karst_ray_end_t expected = step_by_step(map, rays[i], through_unknown);
      EXPECT_EQ(ends[i].state, expected.state) << i;
      EXPECT_EQ(karst::distance(ends[i].center, expected.center), 0) << i;
    }
  }
}

TEST(DrawnHost, GainIsThatOfTheCellsThatNoRockHidesHoweverFar) {
  const DrawnMap map(1.0, {R"(
    ???#?
    ?a..?
    ?#???)"});
  karst_sensor_t lidar{};
  lidar.kind = KARST_SENSOR_LIDAR;
  lidar.T_body_sensor.orientation.w = 1;
  lidar.max_range_m = 9;
  lidar.horizontal_fov_rad = 7;
  lidar.low_elevation_rad = -1.6, lidar.high_elevation_rad = 1.6;
  const Vec3 eye = map.place('a') + Vec3(0.11, 0.07, 0.03);
  std::uint64_t expected = 0;
  for (int x = -10; x < 14; ++x)
    for (int y = -10; y < 14; ++y)
      for (int z = -10; z < 12; ++z) {
        const Vec3 cell = map.center_of({x, y, z});
        expected += map.at(cell) == Cell::unknown && distance(cell, eye) <= 9 &&
                    step_by_step(map, {eye, cell}, true).state == karst_cell_t{KARST_CELL_FREE};
      }
  DrawnHost host(map);
  const karst_viewpoint_t from{eye, 0.0};
  std::uint64_t out = 0;
  host.host()->gain->newly_seen(host.host(), host.map_handle(), &lidar, 1, &from, 1, &out, nullptr);
  EXPECT_EQ(out, expected);
}

TEST(DrawnHost, AColourCameraSeesAPyramidAsADepthCameraDoes) {
  karst_sensor_t camera{};
  camera.kind = KARST_SENSOR_CAMERA;
  camera.T_body_sensor.orientation.w = 1;
  camera.max_range_m = 5;
  camera.horizontal_fov_rad = 1.4;
  camera.low_elevation_rad = -0.5, camera.high_elevation_rad = 0.5;
  karst_sensor_t colour = camera;
  colour.kind = KARST_SENSOR_RGB;
  DrawnHost host(DrawnMap(1.0, {"a"}));
  const karst_sensor_t both[] = {camera, colour};
  const karst_viewpoint_t from{{0.5, 0.5, 0.5}, 0.3};
  std::uint64_t out[2] = {};
  host.host()->gain->newly_seen(host.host(), host.map_handle(), both, 2, &from, 1, out, nullptr);
  EXPECT_EQ(out[0], out[1]);
  EXPECT_GT(out[0], 0u);
}

TEST(DrawnHost, GainStopsAtWalls) {
  karst_sensor_t lidar{};
  lidar.kind = KARST_SENSOR_LIDAR;
  lidar.T_body_sensor.orientation.w = 1;
  lidar.max_range_m = 4.0;
  lidar.horizontal_fov_rad = 0.02;
  lidar.low_elevation_rad = -0.01, lidar.high_elevation_rad = 0.01;
  const auto seen = [&](const char* drawing) {
    DrawnHost host(DrawnMap(1.0, {drawing}));
    const karst_viewpoint_t from{{0.5, 0.5, 0.5}, 0.0};
    std::uint64_t out = 0;
    host.host()->gain->newly_seen(host.host(), host.map_handle(), &lidar, 1, &from, 1, &out, nullptr);
    return out;
  };
  EXPECT_EQ(seen("a.???"), 3u);
  EXPECT_EQ(seen("a.?#?"), 1u);
  EXPECT_EQ(seen("a...."), 0u);
}

}  // namespace
