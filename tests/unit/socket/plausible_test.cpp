#include "plugins/socket/plausible.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace karst::socket {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

core::VehicleDescription vehicle() {
  core::VehicleDescription v;
  core::LidarModel lidar;
  lidar.columns = 4;
  lidar.elevation_rad = {0.1f, -0.1f};
  v.lidar = std::make_shared<const core::LidarModel>(lidar);
  core::CameraModel camera;
  camera.width = 3;
  camera.height = 2;
  camera.horizontal_fov_rad = 1.2;
  camera.vertical_fov_rad = 0.9;
  v.cameras = {std::make_shared<const core::CameraModel>(camera)};
  return v;
}

/// The description with its LiDAR or its camera changed.
template <class Change>
std::string why_lidar(Change change) {
  core::VehicleDescription v = vehicle();
  core::LidarModel lidar = *v.lidar;
  change(lidar);
  v.lidar = std::make_shared<const core::LidarModel>(lidar);
  return implausible(v);
}
template <class Change>
std::string why_camera(Change change) {
  core::VehicleDescription v = vehicle();
  core::CameraModel camera = *v.cameras[0];
  change(camera);
  v.cameras = {std::make_shared<const core::CameraModel>(camera)};
  return implausible(v);
}
template <class Change>
std::string why(Change change) {
  core::VehicleDescription v = vehicle();
  change(v);
  return implausible(v);
}

TEST(Plausible, DescriptionsThatLieAreRefused) {
  EXPECT_EQ(implausible(vehicle()), "");
  EXPECT_EQ(why_lidar([](auto& l) { l.columns = -1; }), "lidar: columns: expected 0 (no rings) to 65536");
  EXPECT_EQ(why_lidar([](auto& l) { l.columns = 0; }), "") << "a LiDAR without rings";
  EXPECT_NE(why_lidar([](auto& l) { l.columns = 0, l.elevation_rad = {0}; }), "");
  EXPECT_NE(why_lidar([](auto& l) { l.azimuth_offset_rad = {0}; }), "");
  EXPECT_EQ(why_lidar([](auto& l) { l.elevation_rad.clear(); }),
            "lidar: elevation_rad: expected 1 to 1024 channels");
  EXPECT_NE(why_lidar([](auto& l) { l.columns = 65536, l.elevation_rad.assign(1000, 0); }), "");
  EXPECT_NE(why_lidar([](auto& l) { l.elevation_rad = {0.1f, 0.1f}; }), "");
  EXPECT_NE(why_lidar([](auto& l) { l.elevation_rad[0] = kNan; }), "");
  EXPECT_NE(why_lidar([](auto& l) { l.max_range_m = kNan; }), "");
  EXPECT_NE(why_lidar([](auto& l) { l.period = 0; }), "");
  EXPECT_NE(why_lidar([](auto& l) { l.T_body_lidar.orientation.w() = 2; }), "");
  EXPECT_NE(why_camera([](auto& c) { c.width = 0; }), "");
  EXPECT_NE(why_camera([](auto& c) { c.width = c.height = 2'000'000'000; }), "");
  EXPECT_NE(why_camera([](auto& c) { c.horizontal_fov_rad = 3.2; }), "");
  EXPECT_NE(why([](auto& v) { v.mass_kg = 0; }), "");
  EXPECT_NE(why([](auto& v) { v.max_thrust_n = 1; }), "") << "it could not lift itself";
  EXPECT_NE(why([](auto& v) { v.radius_m = std::nan(""); }), "");
  EXPECT_NE(why([](auto& v) { v.T_world_start.position.x() = std::nan(""); }), "");
}

TEST(Plausible, MessagesMustFitTheDescription) {
  const core::VehicleDescription v = vehicle();
  core::LidarScan scan;
  scan.range_m.assign(8, 2.0f);
  scan.intensity.assign(8, 0.5f);
  EXPECT_EQ(implausible(scan, v), "");
  scan.range_m[1] = kNan;  // no valid measurement
  scan.range_m[2] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(implausible(scan, v), "");
  scan.range_m[3] = -1;
  EXPECT_EQ(implausible(scan, v), "range_m: is negative");
  scan.range_m.resize(7);
  EXPECT_EQ(implausible(scan, v), "range_m: expected 8 ranges, got 7");
  core::VehicleDescription ringless = v;
  core::LidarModel lidar = *v.lidar;
  lidar.columns = 0;
  ringless.lidar = std::make_shared<const core::LidarModel>(lidar);
  core::LidarScan points;
  points.range_m = {1, 2};
  points.intensity = {0, 1};
  EXPECT_NE(implausible(points, ringless), "") << "no directions";
  points.time_s = {-0.1f, 0};
  points.direction = {core::Vec3f::UnitX(), core::Vec3f::UnitY()};
  EXPECT_EQ(implausible(points, ringless), "");
  points.direction[0] *= 2;
  EXPECT_EQ(implausible(points, ringless), "direction: is no unit vector");
  Depth depth;
  depth.image.range_m.assign(6, 1.0f);
  EXPECT_EQ(implausible(depth, v), "");
  depth.camera = 1;
  EXPECT_EQ(implausible(depth, v), "camera: the vehicle has no such camera");
  EXPECT_NE(implausible(core::PoseSample{}, v), "") << "it has no pose sensor";
  EXPECT_NE(implausible(core::RgbFrame{}, v), "") << "it has no colour camera";
  core::ImuSample imu;
  EXPECT_EQ(implausible(imu, v), "");
  imu.body_rate_radps.y() = std::nan("");
  EXPECT_NE(implausible(imu, v), "");
  core::BatteryStatus battery;
  battery.seconds_left = std::numeric_limits<double>::infinity();
  EXPECT_EQ(implausible(battery, v), "");
  battery.fraction_left = 1.5;
  EXPECT_NE(implausible(battery, v), "");
}

// NaN and -5 were taken.
TEST(Plausible, TheClimbOfAGreetingIsAHeight) {
  Hello hello;
  for (const double good_m : {0.0, 0.3, 20.0}) {
    hello.climb_m = good_m;
    EXPECT_EQ(implausible(hello), "");
  }
  for (const double bad_m : {std::nan(""), -5.0, -1e-9, 101.0, std::numeric_limits<double>::infinity()}) {
    hello.climb_m = bad_m;
    EXPECT_EQ(implausible(hello), "climb_m: expected 0 to 100") << bad_m;
  }
}

TEST(Plausible, CommandsAreNumbers) {
  core::Command c;
  EXPECT_EQ(implausible(c), "");
  c.rates.thrust_n = std::nan("");
  EXPECT_NE(implausible(c), "");
}

TEST(Plausible, TimesNearTheEndsOf64BitsAreRefused) {
  const core::TimeNs least = std::numeric_limits<core::TimeNs>::min();
  for (const core::TimeNs wild : {least, -kMaxTime, kMaxTime, std::numeric_limits<core::TimeNs>::max()}) {
    core::ImuSample imu;
    imu.stamp = wild;
    Depth depth;
    depth.image.stamp = wild;
    Objects objects;
    objects.look.stamp = wild;
    for (const ToCore& m :
         {ToCore(imu), ToCore(depth), ToCore(objects), ToCore(Ground{wild}), ToCore(Lost{wild, {}, {}})})
      EXPECT_EQ(implausible(m, vehicle()), "stamp: is no time");
    EXPECT_EQ(implausible(ToCore(Pong{0, wild, 0}), vehicle()), "sent: is no time");
    EXPECT_EQ(implausible(ToCore(Pong{0, 0, wild}), vehicle()), "sent: is no time");
    core::Command command;
    command.reference.stamp = wild;
    EXPECT_EQ(implausible(command), "stamp: is no time");
  }
  EXPECT_EQ(implausible(ToCore(Ground{kMaxTime - 1}), vehicle()), "");
}

}  // namespace
}  // namespace karst::socket
