#include "core_stack/mapping/occupancy/rays.h"

#include <gtest/gtest.h>

#include <limits>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::shared_ptr<LidarModel> lidar() {
  auto model = std::make_shared<LidarModel>();
  model->columns = 16;
  model->elevation_rad = {0.6f, 0.2f, -0.2f, -0.6f};
  model->max_range_m = 50;
  model->T_body_lidar = {Vec3(0.1, 0, 0.2), Quat(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()))};
  return model;
}

StateHistory resting(const Pose& T_world_body) {
  StateHistory history;
  State s;
  s.position = T_world_body.position, s.orientation = T_world_body.orientation;
  history.push(s);
  s.stamp = kSecond;
  history.push(s);
  return history;
}

TEST(LidarRays, StartAtTheSensorAndEndAtTheReturn) {
  const auto model = lidar();
  const Pose T_world_body{Vec3(3, -2, 1), Quat(Eigen::AngleAxisd(-0.7, Vec3(0, 1, 1).normalized()))};
  LidarScan scan{kSecond / 2, model, {}, {}};
  Random random(1);
  for (int i = 0; i < 64; ++i) scan.range_m.push_back(static_cast<float>(random.uniform(2, 40)));
  const auto rays = to_rays(scan, resting(T_world_body), 0.5, 100);
  ASSERT_EQ(rays.size(), 64u);
  std::size_t i = 0;
  for (int column = 0; column < 16; ++column)
    for (int channel = 0; channel < 4; ++channel, ++i) {
      const Pose T_world_lidar = T_world_body * model->T_body_lidar;
      const float range = scan.range_m[static_cast<std::size_t>(channel * 16 + column)];
      const Vec3 end = T_world_lidar * (model->direction(channel, column) * range).cast<double>();
      EXPECT_TRUE(rays[i].hit);
      EXPECT_LT((rays[i].origin.cast<double>() - T_world_lidar.position).norm(), 1e-5);
      EXPECT_LT((rays[i].end.cast<double>() - end).norm(), 1e-4);  // float at 40 m
    }
}

TEST(LidarRays, OfUnevenBeamsStartOffTheAxisAndPointAsTheModelSays) {
  const auto model = lidar();
  model->azimuth_offset_rad = {0.2f, -0.1f, 0.05f, 0.3f};
  model->beam_origin_m = 0.03f;
  const LidarScan scan{kSecond / 2, model, std::vector<float>(64, 5.0f), {}};
  const auto rays = to_rays(scan, resting(Pose{}), 0.5, 100);
  ASSERT_EQ(rays.size(), 64u);
  std::size_t i = 0;
  for (int column = 0; column < 16; ++column)
    for (int channel = 0; channel < 4; ++channel, ++i) {
      const Vec3 from = model->T_body_lidar * model->origin(column).cast<double>();
      const Vec3 to =
          from + model->T_body_lidar.orientation * (5 * model->direction(channel, column)).cast<double>();
      EXPECT_LT((rays[i].origin.cast<double>() - from).norm(), 1e-6);
      EXPECT_LT((rays[i].end.cast<double>() - to).norm(), 1e-5);
    }
}

TEST(LidarRays, OfPointsWithoutRingsStartFromWhereTheVehicleWasThen) {
  const auto model = lidar();
  model->columns = 0;
  model->T_body_lidar = Pose{};
  StateHistory history;
  for (int i = 0; i <= 100; ++i) {  // 4 m/s along x
    State s;
    s.stamp = i * 10 * kMillisecond;
    s.position = {4 * seconds(s.stamp), 0, 0};
    history.push(s);
  }
  LidarScan scan{kSecond / 2, model, {}, {}};
  for (int i = 0; i < 100; ++i) {
    scan.range_m.push_back(i == 50 ? kNan : i == 51 ? kInf : 6.0f);
    scan.direction.push_back(i % 2 == 0 ? Vec3f::UnitY() : Vec3f::UnitZ());
    scan.time_s.push_back(-0.001f * static_cast<float>(99 - i));
  }
  const auto rays = to_rays(scan, history, 0.5, 20);
  ASSERT_EQ(rays.size(), 99u);
  for (std::size_t i = 0; i < 50; ++i) {
    const Vec3 from(4 * (0.5 - 0.001 * (99 - static_cast<double>(i))), 0, 0);
    EXPECT_LT((rays[i].origin.cast<double>() - from).norm(), 1e-5);
    EXPECT_LT((rays[i].end.cast<double>() - from - 6 * scan.direction[i].cast<double>()).norm(), 1e-5);
    EXPECT_TRUE(rays[i].hit);
  }
  EXPECT_FALSE(rays[50].hit);  // +inf clears as far as the map goes
  EXPECT_NEAR((rays[50].end - rays[50].origin).norm(), 20, 1e-4);
}

TEST(LidarRays, EachColumnStartsFromWhereTheVehicleWasThen) {
  const auto model = lidar();
  model->T_body_lidar = Pose{};
  StateHistory history;
  for (int i = 0; i <= 100; ++i) {  // 4 m/s along x, turning at 1 rad/s
    State s;
    s.stamp = i * 10 * kMillisecond;
    s.position = Vec3(4 * seconds(s.stamp), 0, 0);
    s.orientation = from_heading(seconds(s.stamp));
    history.push(s);
  }
  LidarScan scan{700 * kMillisecond, model, std::vector<float>(64, 5.0f), {}};
  const auto rays = to_rays(scan, history, 0.5, 100);
  ASSERT_EQ(rays.size(), 64u);
  for (std::size_t column = 0; column < 16; ++column) {
    const double t = 0.6 + 0.1 * static_cast<double>(column + 1) / 16;
    const Ray& ray = rays[column * 4 + 1];
    EXPECT_LT((ray.origin - Vec3f(static_cast<float>(4 * t), 0, 0)).norm(), 1e-4);
    const Vec3 d = from_heading(t) * model->direction(1, static_cast<int>(column)).cast<double>();
    EXPECT_LT(((ray.end - ray.origin).cast<double>() - 5 * d).norm(), 1e-3);
  }
}

TEST(LidarRays, InfiniteRangesFreeUpToTheLimitAndInvalidOnesAreDropped) {
  const auto model = lidar();
  LidarScan scan{kSecond / 2, model, std::vector<float>(64, 3.0f), {}};
  scan.range_m[0] = kNan, scan.range_m[1] = kInf, scan.range_m[2] = -1, scan.range_m[3] = 0,
  scan.range_m[4] = 30, scan.range_m[5] = -kInf;
  const auto rays = to_rays(scan, resting(Pose{}), 0, 20);
  ASSERT_EQ(rays.size(), 60u);
  int without_hit = 0;
  for (const Ray& r : rays) {
    EXPECT_NEAR((r.end - r.origin).norm(), r.hit ? 3 : 20, 1e-4);
    without_hit += !r.hit;
  }
  EXPECT_EQ(without_hit, 2);  // the infinite range, and the 30 m beyond the limit of 20
  // Never farther than the sensor itself sees.
  for (const Ray& r : to_rays(scan, resting(Pose{}), 0, 1000)) EXPECT_LE((r.end - r.origin).norm(), 50.001f);
}

TEST(LidarRays, ReturnsFromTheVehicleItselfAreDropped) {
  const auto model = lidar();
  model->T_body_lidar = {Vec3(0, 0, 0.4), Quat::Identity()};
  // 0.5 m from the sensor: below it that is near the body's origin, above it it is not.
  LidarScan scan{kSecond / 2, model, std::vector<float>(64, 0.5f), {}};
  const auto rays = to_rays(scan, resting(Pose{}), 0.5, 20);
  ASSERT_FALSE(rays.empty());
  EXPECT_LT(rays.size(), 64u);
  for (const Ray& r : rays) EXPECT_GE(r.end.norm(), 0.5f);
}

TEST(LidarRays, AScanThatDoesNotFitItsModelGivesNone) {
  EXPECT_TRUE(to_rays(LidarScan{0, nullptr, {1, 2}, {}}, resting(Pose{}), 0, 20).empty());
  EXPECT_TRUE(
      to_rays(LidarScan{0, lidar(), std::vector<float>(63, 1.0f), {}}, resting(Pose{}), 0, 20).empty());
  EXPECT_TRUE(to_rays(LidarScan{0, std::make_shared<LidarModel>(), {}, {}}, resting(Pose{}), 0, 20).empty());
}

TEST(DepthRays, FollowThePinholeModel) {
  auto model = std::make_shared<CameraModel>();
  model->width = 8, model->height = 6, model->horizontal_fov_rad = 1.5, model->vertical_fov_rad = 1.0;
  model->T_body_camera = {Vec3(0, 0, -0.1), Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()))};  // looks down
  const Pose T_world_body{Vec3(1, 2, 3), from_heading(0.4)};
  DepthImage image{kSecond / 2, model, std::vector<float>(48, 2.0f)};
  image.range_m[0] = kNan, image.range_m[1] = kInf;
  const auto rays = to_rays(image, resting(T_world_body), 0.3);
  ASSERT_EQ(rays.size(), 47u);
  EXPECT_FALSE(rays[0].hit);
  EXPECT_NEAR((rays[0].end - rays[0].origin).norm(), model->max_range_m, 1e-4);
  std::size_t i = 1;
  for (int pixel = 2; pixel < 48; ++pixel, ++i) {
    const Vec3f d = 2.0f * model->direction(pixel / 8, pixel % 8);
    const Vec3 end = T_world_body * (model->T_body_camera * d.cast<double>());
    EXPECT_TRUE(rays[i].hit);
    EXPECT_LT((rays[i].end.cast<double>() - end).norm(), 1e-5);
    EXPECT_LT(rays[i].end.z(), 2.9f) << "the camera looks down";
  }
  EXPECT_TRUE(to_rays(DepthImage{0, model, std::vector<float>(47, 1.0f)}, resting(Pose{}), 0).empty());
}

}  // namespace
}  // namespace karst::core
