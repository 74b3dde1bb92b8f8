#include "core_stack/mission/decision/viewpoints.h"

#include <gtest/gtest.h>

#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/mission/drawn_map.h"

namespace karst::core {
namespace {

VehicleDescription lidar_vehicle(double half_fov_rad) {
  auto lidar = std::make_shared<LidarModel>();
  lidar->columns = 8;
  lidar->elevation_rad = {static_cast<float>(half_fov_rad), 0.0f, static_cast<float>(-half_fov_rad)};
  VehicleDescription v;
  v.lidar = lidar;
  return v;
}

VehicleDescription camera_vehicle() {
  auto camera = std::make_shared<CameraModel>();
  camera->horizontal_fov_rad = 1.38;
  camera->vertical_fov_rad = 1.12;
  camera->max_range_m = 4.5f;
  VehicleDescription v;
  v.cameras = {camera};
  return v;
}

TEST(InView, LidarSeesItsElevationBandAllAround) {
  const VehicleDescription v = lidar_vehicle(0.26);
  const Viewpoint here{Vec3::Zero(), 1.0};
  EXPECT_TRUE(in_view(v, here, Vec3(5, 0, 0), 10));
  EXPECT_TRUE(in_view(v, here, Vec3(-5, 0, 1.2), 10));
  EXPECT_FALSE(in_view(v, here, Vec3(-5, 0, 1.5), 10)) << "above the band: atan(1.5/5) > 0.26";
  EXPECT_FALSE(in_view(v, here, Vec3(11, 0, 0), 10)) << "beyond the range";
}

TEST(InView, ACameraSeesOnlyWhereItLooks) {
  const VehicleDescription v = camera_vehicle();
  EXPECT_TRUE(in_view(v, {Vec3::Zero(), 0}, Vec3(3, 0, 0), 10));
  EXPECT_FALSE(in_view(v, {Vec3::Zero(), 1.5}, Vec3(3, 0, 0), 10));
  EXPECT_TRUE(in_view(v, {Vec3::Zero(), M_PI / 2}, Vec3(0, 3, 0), 10));
  EXPECT_FALSE(in_view(v, {Vec3::Zero(), 0}, Vec3(3, 0, 2.5), 10)) << "above its field of view";
  EXPECT_FALSE(in_view(v, {Vec3::Zero(), 0}, Vec3(4.4, 0, 0), 10)) << "at the very end of its range";
}

class ViewpointInARoom : public ::testing::TestWithParam<bool> {};

TEST_P(ViewpointInARoom, IsClearAndSeesTheOpening) {
  const VehicleDescription vehicle = GetParam() ? lidar_vehicle(0.4) : camera_vehicle();
  VoxelMap map{MapOptions{}};
  carve_box(map, Vec3(0, 0, 0), Vec3(8, 6, 4), {"x+"});  // all that leads on is the face at x = 8
  Frontiers frontiers{FrontierOptions{}};
  std::vector<CellChange> changes;
  map.for_each_known([&](const CellKey& k, Cell c, float) { changes.push_back({k, Cell::unknown, c}); });
  frontiers.update(map, changes);
  ASSERT_FALSE(frontiers.clusters().empty());
  const double clearance = PlanningOptions{}.clearance_m;
  int found = 0;
  for (const auto& [id, cluster] : frontiers.clusters()) {
    const auto v = find_viewpoint(map, cluster, vehicle, clearance);
    if (!v) continue;
    ++found;
    EXPECT_TRUE(is_clear(map, v->position, clearance));
    EXPECT_LT(v->position.x(), cluster.centroid.x());
    bool some = false;
    for (const CellKey& k : cluster.cells)
      some = some || (in_view(vehicle, *v, map.center_of(k), 10) &&
                      !map.first_not_free(v->position, map.center_of(k)));
    EXPECT_TRUE(some) << "no cell of cluster " << id << " is seen from its viewpoint";
  }
  EXPECT_GT(found, 0);
}
INSTANTIATE_TEST_SUITE_P(Sensors, ViewpointInARoom, ::testing::Bool());

TEST(OpenCells, AnOpeningHasSomeAndAChinkHasNone) {
  VoxelMap map{MapOptions{}};
  carve_box(map, Vec3(0, 0, 0), Vec3(4, 2, 2), {"x+"});  // walls of one cell: 8 x 8 free cells at x = 4
  FrontierCluster opening, chink;
  for (int y = 1; y <= 8; ++y)
    for (int z = 1; z <= 8; ++z) opening.cells.push_back({19, y, z});
  EXPECT_EQ(open_cells(map, opening), 6 * 6);
  for (int y = 1; y <= 8; ++y) chink.cells.push_back({10, y, 1});  // a seam along the floor
  EXPECT_EQ(open_cells(map, chink), 0);
}

TEST(FindViewpoint, ThereIsNoneInASpaceTooSmallForTheVehicle) {
  VoxelMap map{MapOptions{}};
  carve_box(map, Vec3(0, 0, 0), Vec3(8, 0.8, 0.8), {"x+"});
  FrontierCluster cluster;
  cluster.cells = {map.key_of(Vec3(7.9, 0.4, 0.4))};
  cluster.centroid = Vec3(7.9, 0.4, 0.4);
  cluster.normal = Vec3::UnitX();
  EXPECT_FALSE(find_viewpoint(map, cluster, lidar_vehicle(0.4), PlanningOptions{}.clearance_m));
}

}  // namespace
}  // namespace karst::core
