// The test kit's sensors are those of the simulator, and the bench has one.
#include <karst/testing/sensors.h>

#include <gtest/gtest.h>

#include <karst/policy.h>
#include <karst/testing/bench.h>

#include "plugins/simulator/cameras/depth_camera.h"
#include "plugins/simulator/sensors/lidar.h"

namespace {

using karst::testing::Bench;
using karst::testing::DrawnMap;
using karst::testing::Facing;

constexpr double kFloat = 1e-6;  // the models hold floats

void expect_pose(const karst_pose_t& pose, const karst::core::Pose& expected) {
  EXPECT_NEAR(pose.position.x, expected.position.x(), kFloat);
  EXPECT_NEAR(pose.position.y, expected.position.y(), kFloat);
  EXPECT_NEAR(pose.position.z, expected.position.z(), kFloat);
  const karst_quaternion_t& q = pose.orientation;
  EXPECT_NEAR(karst::core::Quat(q.w, q.x, q.y, q.z).angularDistance(expected.orientation), 0, kFloat);
  EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-12);
}

TEST(Sensors, TheLidarIsTheSimulatorsByDefault) {
  const auto model = karst::sim::lidar_model(karst::sim::LidarOptions{});
  const karst::Sensor s = karst::testing::lidar();
  EXPECT_EQ(karst::from_abi(s.name), model->name);
  EXPECT_EQ(s.kind, karst_sensor_kind_t{KARST_SENSOR_LIDAR});
  expect_pose(s.T_body_sensor, model->T_body_lidar);
  EXPECT_NEAR(s.min_range_m, static_cast<double>(model->min_range_m), kFloat);
  EXPECT_NEAR(s.max_range_m, static_cast<double>(model->max_range_m), kFloat);
  EXPECT_NEAR(s.horizontal_fov_rad, 2 * std::acos(-1.0), 1e-12);
  EXPECT_NEAR(s.high_elevation_rad, static_cast<double>(model->elevation_rad.front()), kFloat);
  EXPECT_NEAR(s.low_elevation_rad, static_cast<double>(model->elevation_rad.back()), kFloat);
  EXPECT_EQ(karst::testing::lidar(7).max_range_m, 7);
}

TEST(Sensors, TheDepthCamerasAreTheSimulatorsByDefault) {
  const std::pair<Facing, karst::sim::Facing> all[] = {{Facing::forward, karst::sim::Facing::forward},
                                                       {Facing::up, karst::sim::Facing::up},
                                                       {Facing::down, karst::sim::Facing::down}};
  for (const auto& [facing, simulated] : all) {
    const auto model = karst::sim::camera_model(karst::sim::CameraOptions{}, simulated);
    SCOPED_TRACE(model->name);
    const karst::Sensor s = karst::testing::depth_camera(facing);
    EXPECT_EQ(karst::from_abi(s.name), model->name);
    EXPECT_EQ(s.kind, karst_sensor_kind_t{KARST_SENSOR_CAMERA});
    expect_pose(s.T_body_sensor, model->T_body_camera);
    EXPECT_NEAR(s.min_range_m, static_cast<double>(model->min_range_m), kFloat);
    EXPECT_NEAR(s.max_range_m, static_cast<double>(model->max_range_m), kFloat);
    EXPECT_NEAR(s.horizontal_fov_rad, model->horizontal_fov_rad, 1e-12);
    EXPECT_NEAR(s.high_elevation_rad, model->vertical_fov_rad / 2, 1e-12);
    EXPECT_NEAR(s.low_elevation_rad, -model->vertical_fov_rad / 2, 1e-12);
  }
}

/// Tells what its sensors are, and what they would see of a place to its east.
class Looking : public karst::Policy {
  karst::Decision decide(const karst::Request& r) override {
    std::string all;
    for (const karst::Sensor& s : r.sensors)
      all += karst::from_abi(s.name) + " " + std::to_string(r.newly_seen(s, {{r.position(), 0.0}})[0]) + ";";
    return karst::Decision::hold(all);
  }
};
const karst_plugin_t* looking() {
  static const auto policy = [](std::uint32_t) noexcept {
    return karst::border::entry<Looking>("looking", "1.0.0", "Looks.");
  };
  static const karst_plugin_t plugin{sizeof(karst_plugin_t), KARST_ABI_MAJOR, KARST_ABI_MINOR, 1, policy};
  return &plugin;
}

// As it was: the bench had no sensor, and a policy that asked what it would see found nothing anywhere.
TEST(Bench, BeginsWithALidar) {
  Bench bench(looking(), DrawnMap(1.0, {"#a.??"}));
  bench.position = bench.host().map().place('a');
  ASSERT_EQ(bench.sensors.size(), 1u);
  EXPECT_EQ(karst::from_abi(bench.sensors.front().name), "os0_32");
  bench.sensors = {karst::testing::lidar(4)};
  const std::string by_lidar = bench.decide().reason;
  EXPECT_TRUE(by_lidar.starts_with("os0_32 ")) << by_lidar;
  EXPECT_NE(by_lidar, "os0_32 0;");
  bench.sensors = {karst::testing::depth_camera(), karst::testing::depth_camera(Facing::up)};
  const std::string by_cameras = bench.decide().reason;
  EXPECT_NE(by_cameras.find("forward "), std::string::npos) << by_cameras;
  EXPECT_NE(by_cameras.find("up "), std::string::npos) << by_cameras;
}

}  // namespace
