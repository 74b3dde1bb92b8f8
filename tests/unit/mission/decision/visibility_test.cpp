#include "core_stack/mission/decision/visibility.h"

#include <gtest/gtest.h>

#include <numbers>

namespace karst::core {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

VehicleDescription vehicle_with_fov(double half_fov_rad) {
  auto lidar = std::make_shared<LidarModel>();
  lidar->elevation_rad = {static_cast<float>(half_fov_rad), static_cast<float>(-half_fov_rad)};
  VehicleDescription v;
  v.lidar = lidar;
  return v;
}

std::vector<Vec3> line(const Vec3& from, const Vec3& to) {
  std::vector<Vec3> points;
  const int n = static_cast<int>((to - from).norm() / 0.1);
  for (int i = 0; i <= n; ++i) points.push_back(from + (to - from) * i / n);
  return points;
}

TEST(SteepestView, IsTheLidarsHighestRingOrTheCameraThatFacesUp) {
  VehicleDescription v = vehicle_with_fov(15.5 * kDegree);
  EXPECT_NEAR(steepest_view(v).up_rad, 15 * kDegree, 1e-6);
  EXPECT_NEAR(steepest_view(v).down_rad, 15 * kDegree, 1e-6);
  auto up = std::make_shared<CameraModel>();
  up->T_body_camera.orientation = Quat(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitY()));
  up->horizontal_fov_rad = up->vertical_fov_rad = 1.0;
  up->max_range_m = 5;
  v.cameras = {up};
  EXPECT_NEAR(steepest_view(v).up_rad, 90 * kDegree, 1e-6);
  EXPECT_NEAR(steepest_view(v).down_rad, 15 * kDegree, 1e-6);
}

TEST(BlindClimb, AShaftIsRefusedWithTheReasonAndARampIsNot) {
  const SteepestView view{30 * kDegree, 30 * kDegree};
  const auto shaft = blind_climb(view, {}, line({0, 0, 0}, {0, 0, 10}));
  ASSERT_TRUE(shaft);
  EXPECT_NE(shaft->find("m up within 0.0 m"), std::string::npos) << *shaft;
  EXPECT_NE(shaft->find("steeper up than 30 deg"), std::string::npos) << *shaft;
  EXPECT_TRUE(blind_climb(view, {}, line({0, 0, 0}, {0, 0, -10})));
  EXPECT_TRUE(blind_climb(view, {}, line({0, 0, 0}, {10, 0, 6.0})));
  EXPECT_FALSE(blind_climb(view, {}, line({0, 0, 0}, {10, 0, 5.5})));
  EXPECT_FALSE(blind_climb(view, {}, line({0, 0, 0}, {0, 0, 2.9}))) << "a ledge";
}

TEST(BlindClimb, NothingIsTooSteepForAVehicleThatLooksUpAndDown) {
  const SteepestView view{90 * kDegree, 90 * kDegree};
  EXPECT_FALSE(blind_climb(view, {}, line({0, 0, 0}, {0, 0, 30})));
  EXPECT_TRUE(blind_climb({90 * kDegree, 0}, {}, line({0, 0, 0}, {0, 0, -30}))) << "it does not look down";
}

TEST(BlindClimb, NoLevelIsNewBesideWhereTheVehicleWasAsHighOrAsLow) {
  // As it was: a vehicle that had come up 3.3 m was refused every goal, the way it had come included.
  const SteepestView view{30 * kDegree, 30 * kDegree};
  for (const double sign : {1.0, -1.0}) {
    const Vec3 there(0, 0, 3.3 * sign);
    const std::vector<Vec3> path = line({0, 0, 0}, there);
    EXPECT_FALSE(blind_climb(view, path, line(there, {0, 0, 0})));
    EXPECT_FALSE(blind_climb(view, path, line(there, {3.5, 0, 0}))) << "beside";
    EXPECT_FALSE(blind_climb(view, path, line(there, {1, 0, 3.2 * sign}))) << "what is done is done";
    EXPECT_TRUE(blind_climb(view, path, line(there, {0, 0, -0.2 * sign}))) << "farther than it came from";
    EXPECT_TRUE(blind_climb(view, path, line(there, {0, 0, 3.5 * sign}))) << "farther than it is";
    EXPECT_TRUE(blind_climb(view, path, line(there, {4.5, 0, 0}))) << "elsewhere";
  }
}

TEST(BlindClimb, AWayFlownLongAgoNeedNotBeMetToTheCentimetre) {
  const SteepestView view{30 * kDegree, 30 * kDegree};
  std::vector<Vec3> path = line({0, 0, 0}, {0, 0, 3.3});
  const auto back_to = [&](double z) {
    return blind_climb(view, path, line({0, 0, 3.3}, {0, 0, z})).has_value();
  };
  EXPECT_TRUE(back_to(-0.4));
  for (int i = 0; i < 25; ++i)  // to and fro, 50 m of way
    for (const double y : {0.0, 1.0}) path.push_back({0, y, 3.3});
  EXPECT_FALSE(back_to(-0.4));
  path.back() = {0, 0, 3.3};
  path.push_back({0, 0, 0.2});  // the climb down is new: half a metre below it, that is, and no more
  path.push_back({0, 0, 3.3});
  EXPECT_FALSE(back_to(-0.4));
  EXPECT_TRUE(back_to(-0.6));
}

TEST(BlindClimb, GoesByTheWayComeTooAndIsNotDeceivedBySweeping) {
  const SteepestView view{15 * kDegree, 15 * kDegree};
  // Up a shaft 3 m wide in steps of 0.7 m, to and fro: each step by itself is a ledge.
  std::vector<Vec3> path;
  bool refused = false;
  for (int i = 0; i < 10 && !refused; ++i) {
    const Vec3 from(i % 2 ? 3 : 0, 0, 0.7 * i), to(i % 2 ? 0 : 3, 0, 0.7 * (i + 1));
    const std::vector<Vec3> step = line(from, to);
    refused = blind_climb(view, path, step).has_value();
    EXPECT_EQ(refused, 0.7 * (i + 1) > 3.0) << i;
    path.insert(path.end(), step.begin(), step.end());
  }
  EXPECT_TRUE(refused);
}

}  // namespace
}  // namespace karst::core
