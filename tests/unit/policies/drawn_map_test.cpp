#include <gtest/gtest.h>

#include <karst/policy.h>
#include <karst/testing/drawn_host.h>

#include <cmath>

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
