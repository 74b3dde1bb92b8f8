// Rays spread over the view against a look at each cell (the drawn host's).
#include "sdk/host/services/gain.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "sdk/host/services/translation.h"
#include "tests/unit/host/services/drawn.h"

namespace karst::test {
namespace {

karst_sensor_t lidar(double range_m) {
  karst_sensor_t s{};
  s.kind = KARST_SENSOR_LIDAR;
  s.T_body_sensor.orientation.w = 1;
  s.max_range_m = range_m;
  s.horizontal_fov_rad = 2 * std::numbers::pi;
  s.low_elevation_rad = -0.8, s.high_elevation_rad = 0.8;
  return s;
}
karst_sensor_t camera(double range_m) {
  karst_sensor_t s = lidar(range_m);
  s.kind = KARST_SENSOR_CAMERA;
  s.horizontal_fov_rad = 1.5;
  s.low_elevation_rad = -0.5, s.high_elevation_rad = 0.5;
  return s;
}
/// Pitched up by a quarter turn: body x to world z.
karst_sensor_t upward_camera(double range_m) {
  karst_sensor_t s = camera(range_m);
  s.T_body_sensor.orientation = {std::sqrt(0.5), 0, -std::sqrt(0.5), 0};
  return s;
}

std::uint64_t cell_by_cell(const testing::DrawnMap& map, const karst_sensor_t& s,
                           const karst_viewpoint_t& v) {
  testing::DrawnHost host(map);
  std::uint64_t out = 0;
  host.host()->gain->newly_seen(host.host(), host.map_handle(), &s, 1, &v, 1, &out, nullptr);
  return out;
}
std::uint64_t by_rays(const testing::DrawnMap& map, const karst_sensor_t& s, const karst_viewpoint_t& v) {
  return host::SensorRays(s, map.resolution_m()).newly_seen(to_core_map(map), v);
}

/// A room of free cells with walls, and a doorway to the east. Cells of 0.5 m.
testing::DrawnMap room_with_door() {
  std::vector<std::string> layers;
  for (int z = 0; z < 10; ++z) {
    std::string layer;
    for (int y = 0; y < 12; ++y, layer += '\n')
      for (int x = 0; x < 12; ++x) {
        const bool wall = x == 0 || y == 0 || z == 0 || x == 11 || y == 11 || z == 9;
        const bool door = x == 11 && y >= 4 && y <= 7 && z >= 2 && z <= 6;
        layer += door ? '.' : wall ? '#' : '.';
      }
    layers.push_back(layer);
  }
  return {0.5, layers};
}

TEST(Gain, AgreesWithALookAtEachCellUpToTheBordersOfTheView) {
  const testing::DrawnMap room = room_with_door();
  const karst_viewpoint_t from{{3.25, 3.1, 2.4}, 0.1};
  for (const karst_sensor_t& s : {lidar(8.0), camera(8.0)}) {
    const double expected = static_cast<double>(cell_by_cell(room, s, from));
    ASSERT_GT(expected, 200);
    // A cell is seen if any ray meets it, not just its centre: the border of the view adds a layer.
    const double seen = static_cast<double>(by_rays(room, s, from));
    EXPECT_GE(seen, 0.98 * expected);
    EXPECT_LE(seen, 1.5 * expected);
  }
}

TEST(Gain, IsZeroWhereAllIsKnown) {
  testing::DrawnMap closed = room_with_door();
  const karst_viewpoint_t away_from_door{{3.25, 3.1, 2.4}, std::numbers::pi};
  EXPECT_EQ(by_rays(closed, camera(8.0), away_from_door), 0u) << "it looks at the wall";
  EXPECT_EQ(by_rays(closed, upward_camera(8.0), away_from_door), 0u);
}

TEST(Gain, InTheOpenIsTheVolumeOfTheView) {
  const testing::DrawnMap nothing(0.2, {"."});
  const double range = 6.0;
  const karst_sensor_t s = lidar(range);
  const double solid_angle = 2 * std::numbers::pi * 2 * std::sin(0.8);
  const double cells = solid_angle * range * range * range / 3 / (0.2 * 0.2 * 0.2);
  const double seen = static_cast<double>(by_rays(nothing, s, {{0.1, 0.1, 0.1}, 0.0}));
  EXPECT_NEAR(seen / cells, 1.0, 0.05);
}

TEST(Gain, GrowsWithTheRangeAndNeverShrinks) {
  const testing::DrawnMap room = room_with_door();
  std::uint64_t last = 0;
  for (double range = 1.0; range < 10.0; range += 0.5) {
    const std::uint64_t seen = by_rays(room, lidar(range), {{3.25, 3.1, 2.4}, 0.0});
    EXPECT_GE(seen, last) << range;
    last = seen;
  }
  EXPECT_GT(last, 0u);
}

TEST(Gain, TurningTheVehicleTurnsACamera) {
  const testing::DrawnMap room = room_with_door();
  const auto seen = [&](double heading) { return by_rays(room, camera(8.0), {{3.25, 3.1, 2.4}, heading}); };
  EXPECT_GT(seen(0.0), 0u);
  EXPECT_EQ(seen(std::numbers::pi / 2), 0u);
}

/// Ray by ray, one cell at a time.
std::uint64_t by_single_rays(const core::VoxelMap& map, const karst_sensor_t& s, const karst_viewpoint_t& v) {
  const karst_quaternion_t& q = s.T_body_sensor.orientation;
  const core::Pose T_world_sensor =
      core::Pose{host::to_core(v.position), core::from_heading(v.heading_rad)} *
      core::Pose{host::to_core(s.T_body_sensor.position), core::Quat(q.w, q.x, q.y, q.z)};
  const core::Vec3 eye = T_world_sensor.position / map.resolution_m();
  const double furthest = s.max_range_m / map.resolution_m(), nearest = s.min_range_m / map.resolution_m();
  std::set<core::CellKey> seen;
  const host::SensorRays rays(s, map.resolution_m());
  for (const core::Vec3& ray : rays.directions()) {
    const core::Vec3 d = T_world_sensor.orientation * ray;
    std::array<std::int32_t, 3> cell;
    std::array<double, 3> next, period;
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(a);
      const double floor = std::floor(eye[a]);
      cell[i] = static_cast<std::int32_t>(floor);
      next[i] = period[i] = d[a] == 0 ? HUGE_VAL : std::abs(1.0 / d[a]);
      if (d[a] != 0) next[i] *= d[a] < 0 ? eye[a] - floor : floor + 1.0 - eye[a];
    }
    for (;;) {
      const core::CellKey k{cell[0], cell[1], cell[2]};
      if (map.at(k) == core::Cell::occupied) break;
      const double away = (core::Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5) - eye).norm();
      if (map.at(k) == core::Cell::unknown && away >= nearest && away <= furthest) seen.insert(k);
      const std::size_t yz = next[1] < next[2] ? 1 : 2, i = next[0] < next[yz] ? 0 : yz;
      if (next[i] > furthest) break;
      cell[i] += d[static_cast<int>(i)] < 0 ? -1 : 1;
      next[i] += period[i];
    }
  }
  return seen.size();
}

TEST(Gain, OfRaysWalkedTogetherIsThatOfEachRayByItself) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 30; ++i) {
    core::VoxelMap map({.resolution_m = 0.2});
    const auto blob = [&](int edge, float log_odds) {
      const auto at = [&] { return static_cast<std::int32_t>(25 * uniform(random)); };
      map.assign({at(), at(), at()}, edge, log_odds);
    };
    for (int n = 0; n < 60; ++n) blob(1 + n % 12, -1.0f);
    for (int n = 0; n < 150; ++n) blob(1 + n % 3, 1.0f);
    karst_sensor_t s = i % 3 == 0 ? lidar(4.0) : i % 3 == 1 ? camera(4.1) : upward_camera(3.9);
    s.min_range_m = i % 2 == 0 ? 0.0 : 1.0;
    s.T_body_sensor.position = {0.1, 0, 0.05};
    karst_viewpoint_t from{{uniform(random), uniform(random), uniform(random)}, 3 * uniform(random)};
    // On the borders of cells, along the axes: equal lengths, and rays that meet no border.
    if (i % 5 == 0) from = {{0.3, 0.2, 0.15}, std::numbers::pi / 2 * (i / 5)};
    EXPECT_EQ(host::SensorRays(s, 0.2).newly_seen(map, from), by_single_rays(map, s, from)) << i;
  }
}

TEST(Gain, OfOneViewpointDoesNotDependOnTheOnesBefore) {
  const core::VoxelMap room = to_core_map(room_with_door());
  host::SensorRays rays(lidar(8.0), room.resolution_m());
  const karst_viewpoint_t here{{3.25, 3.1, 2.4}, 0.0}, there{{4.6, 2.9, 2.2}, 1.0};
  const std::uint64_t first = rays.newly_seen(room, here);
  EXPECT_NE(rays.newly_seen(room, there), first);
  EXPECT_EQ(rays.newly_seen(room, here), first);
}

TEST(SensorFault, NamesWhatIsWrong) {
  karst_sensor_t s = lidar(8.0);
  EXPECT_EQ(host::sensor_fault(s), "");
  s.max_range_m = 61;
  EXPECT_NE(host::sensor_fault(s).find("max_range_m"), std::string::npos);
  s = lidar(8.0);
  s.low_elevation_rad = 1;
  EXPECT_NE(host::sensor_fault(s).find("elevations"), std::string::npos);
  s = lidar(8.0);
  s.T_body_sensor.orientation = {};
  EXPECT_NE(host::sensor_fault(s).find("quaternion"), std::string::npos);
  s = camera(8.0);
  s.horizontal_fov_rad = 3.1;
  EXPECT_NE(host::sensor_fault(s).find("horizontal"), std::string::npos);
  for (const double far : {10.1, -1e300, std::nan(""), HUGE_VAL}) {
    s = lidar(8.0);
    s.T_body_sensor.position.y = far;
    EXPECT_NE(host::sensor_fault(s).find("T_body_sensor"), std::string::npos) << far;
  }
}

TEST(SensorExcess, IsALookThatWouldNeedTooMuchMemory) {
  karst_sensor_t all_around = lidar(60.0);
  all_around.low_elevation_rad = -std::numbers::pi / 2, all_around.high_elevation_rad = std::numbers::pi / 2;
  EXPECT_EQ(host::sensor_excess(all_around, 0.2), "");
  EXPECT_NE(host::sensor_excess(all_around, 0.05).find("300 cells"), std::string::npos) << "13.9 GB";
  EXPECT_EQ(host::sensor_excess(lidar(15.0), 0.05), "");
  karst_sensor_t wide = camera(60.0);
  EXPECT_EQ(host::sensor_excess(wide, 0.2), "");
  wide.horizontal_fov_rad = 3.0;
  wide.low_elevation_rad = -1.49, wide.high_elevation_rad = 1.49;
  EXPECT_NE(host::sensor_excess(wide, 0.2).find("rays"), std::string::npos) << "60 million rays";
  wide.max_range_m = 8.0;
  EXPECT_EQ(host::sensor_excess(wide, 0.2), "");
}

}  // namespace
}  // namespace karst::test
