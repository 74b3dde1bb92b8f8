#include "sdk/preflight/vehicle/scan_view.h"

#include <gtest/gtest.h>

#include <functional>

#include "core_stack/common/so3.h"
#include "tests/unit/preflight/vehicle/box_room.h"
#include "tests/unit/preflight/vehicle/degree.h"

namespace karst::preflight {
namespace {

using core::LidarScan;
using core::Vec3;

using test::kDegree;

/// The view of ten scans, each changed.
LidarView view_of(const std::function<void(LidarScan&, int scan)>& change) {
  std::vector<std::shared_ptr<const LidarScan>> scans;
  for (int i = 0; i < 10; ++i) {
    LidarScan scan = test::scan_of({}, test::lidar_of(), 0.02, static_cast<std::uint64_t>(i + 1));
    change(scan, i);
    scans.push_back(std::make_shared<const LidarScan>(std::move(scan)));
  }
  return lidar_view(scans, 0.3);
}

/// Gives the beams between two azimuths of the body frame this range.
void put(LidarScan& scan, double from_deg, double to_deg, float range_m) {
  for (int c = 0; c < scan.model->channels(); ++c)
    for (int j = 0; j < scan.model->columns; ++j) {
      const core::Vec3f d = scan.model->direction(c, j);
      const double azimuth_deg = std::atan2(static_cast<double>(d.y()), static_cast<double>(d.x())) / kDegree;
      if (azimuth_deg > from_deg && azimuth_deg < to_deg)
        scan.range_m[static_cast<std::size_t>(c * scan.model->columns + j)] = range_m;
    }
}

TEST(LidarView, OfACleanLidar) {
  const LidarView v = view_of([](LidarScan&, int) {});
  EXPECT_EQ(v.scans, 10);
  EXPECT_EQ(v.misshapen, 0);
  EXPECT_EQ(v.blocked.width_rad, 0);
  EXPECT_NEAR(v.noise_m, 0.02, 0.003);
  EXPECT_EQ(v.flicker, 0);
  EXPECT_NEAR(v.intensity, 0.4, 1e-6);
  for (const double clear : v.clear) EXPECT_EQ(clear, 1);
}

TEST(LidarView, FindsASectorWithoutReturns) {
  for (const float nothing :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 0.0f}) {
    const LidarView v = view_of([&](LidarScan& s, int) { put(s, 40, 80, nothing); });
    EXPECT_NEAR(v.blocked.from_rad, 40 * kDegree, 1e-6);
    EXPECT_NEAR(v.blocked.width_rad, 40 * kDegree, 1e-6);
    EXPECT_FALSE(v.blocked.hull);
  }
}

TEST(LidarView, FindsASectorAcrossForward) {
  const LidarView v = view_of([](LidarScan& s, int) { put(s, -15, 20, NAN); });
  EXPECT_NEAR(v.blocked.from_rad, 345 * kDegree, 1e-6);
  EXPECT_NEAR(v.blocked.width_rad, 35 * kDegree, 1e-6);
}

TEST(LidarView, FindsWhatStandsOnTheOwnHull) {
  const LidarView v = view_of([](LidarScan& s, int) { put(s, 90, 120, 0.25f); });
  EXPECT_NEAR(v.blocked.width_rad, 30 * kDegree, 1e-6);
  EXPECT_TRUE(v.blocked.hull);
}

TEST(LidarView, SectorsAreOfTheBodyAndNotOfTheLidar) {
  std::vector<std::shared_ptr<const LidarScan>> scans;
  auto model = test::lidar_of();
  model->T_body_lidar.orientation = core::exp_so3(Vec3(0, 0, 90 * kDegree));
  LidarScan scan = test::scan_of({}, model);
  put(scan, 0, 30, NAN);
  scans.push_back(std::make_shared<const LidarScan>(scan));
  EXPECT_NEAR(lidar_view(scans, 0.3).blocked.from_rad, 90 * kDegree, 1e-6);
}

TEST(LidarView, MeasuresNoiseAndBeamsThatComeAndGo) {
  const LidarView v = view_of([](LidarScan& s, int scan) {
    core::Random random(static_cast<std::uint64_t>(scan + 100));
    for (float& r : s.range_m) {
      r += static_cast<float>(0.1 * random.normal());
      if (random.uniform() < 0.3) r = NAN;
    }
  });
  EXPECT_NEAR(v.noise_m, 0.1, 0.015);
  EXPECT_GT(v.flicker, 0.8);
}

TEST(LidarView, CountsScansOfAnotherSize) {
  const LidarView v = view_of([](LidarScan& s, int scan) {
    if (scan == 3) s.range_m.pop_back();
    if (scan == 4) s.model = nullptr;
  });
  EXPECT_EQ(v.misshapen, 2);
  EXPECT_EQ(v.scans, 8);
}

TEST(LidarView, OfALidarWithoutRings) {
  auto model = test::lidar_of();
  LidarScan ringed = test::scan_of({}, model);
  put(ringed, 40, 80, NAN);
  auto loose = std::make_shared<core::LidarModel>(*model);
  LidarScan scan = ringed;
  for (int c = 0; c < model->channels(); ++c)
    for (int j = 0; j < model->columns; ++j) scan.direction.push_back(model->direction(c, j));
  scan.time_s.assign(scan.range_m.size(), 0.0f);
  loose->columns = 0;
  scan.model = loose;
  const std::vector<std::shared_ptr<const LidarScan>> scans(3, std::make_shared<const LidarScan>(scan));
  const LidarView v = lidar_view(scans, 0.3);
  EXPECT_EQ(v.scans, 3);
  EXPECT_EQ(v.misshapen, 0);
  EXPECT_NEAR(v.blocked.from_rad, 40 * kDegree, 1e-6);
  EXPECT_NEAR(v.blocked.width_rad, 40 * kDegree, 1e-6);
}

TEST(LidarView, OfNoScan) { EXPECT_EQ(lidar_view({}, 0.3).scans, 0); }

TEST(PadRoom, MeasuresTheRoomAroundTheHull) {
  for (const double half_width_m : {0.8, 1.5, 2.5}) {
    const PadRoom r =
        pad_room(test::record_in({.half_width_m = half_width_m}, test::lidar_of()), Vec3(0, 0, 9.81), 0.7);
    EXPECT_TRUE(r.known);
    EXPECT_NEAR(r.around_m, half_width_m - 0.3, 0.08) << "noise of 2 cm, the nearest of many returns";
    EXPECT_FALSE(r.points.empty());
  }
}

TEST(PadRoom, ALidarThatLooksUpSeesTheCeiling) {
  const PadRoom r = pad_room(test::record_in({.above_m = 1.4}, test::lidar_of(85)), Vec3(0, 0, 9.81), 0.7);
  EXPECT_TRUE(r.seen_above);
  EXPECT_NEAR(r.above_m, 1.4, 0.08);
}

TEST(PadRoom, ALidarOf45DegreesDoesNotLookStraightUp) {
  const PadRoom r = pad_room(test::record_in({.above_m = 1.4}, test::lidar_of(45)), Vec3(0, 0, 9.81), 0.7);
  EXPECT_FALSE(r.seen_above);
  EXPECT_EQ(r.above_m, r.above_looked_m);
}

TEST(PadRoom, ADepthCameraLooksUp) {
  VehicleRecord record = test::record_in({}, test::lidar_of());
  auto camera = std::make_shared<core::CameraModel>();
  camera->width = camera->height = 20;
  camera->horizontal_fov_rad = camera->vertical_fov_rad = 1;
  camera->T_body_camera.orientation = core::exp_so3(Vec3(0, -90 * kDegree, 0));  // x up
  core::DepthImage image{0, camera, {}};
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 20; ++column) {
      const Vec3 d = camera->T_body_camera.orientation * camera->direction(row, column).cast<double>();
      image.range_m.push_back(static_cast<float>(1.1 / d.z()));
    }
  record.cameras.push_back({{}, {std::make_shared<const core::DepthImage>(image)}});
  const PadRoom r = pad_room(record, Vec3(0, 0, 9.81), 0.7);
  EXPECT_TRUE(r.seen_above);
  EXPECT_NEAR(r.above_m, 1.1, 0.01);
}

TEST(PadRoom, UpIsAgainstGravityAndNotAlongTheBody) {
  // The room is upright for the vehicle, and gravity says that it leans by 30 degrees.
  const Vec3 up = core::exp_so3(Vec3(0, 30 * kDegree, 0)) * Vec3::UnitZ();
  const PadRoom level = pad_room(test::record_in({.above_m = 1.2}, test::lidar_of(80)), Vec3::UnitZ(), 0.7);
  const PadRoom leaning = pad_room(test::record_in({.above_m = 1.2}, test::lidar_of(80)), up, 0.7);
  EXPECT_NEAR(level.above_m, 1.2, 0.08);
  // Along gravity: 1.2 m / cos(30 deg) at the axis, less at the edge of the column, 0.4 m aside.
  EXPECT_NEAR(leaning.above_m, 1.2 / std::cos(30 * kDegree) - 0.4 * std::tan(30 * kDegree), 0.12);
}

TEST(PadRoom, IsUnknownWithoutReturns) { EXPECT_FALSE(pad_room({}, Vec3::UnitZ(), 0.7).known); }

}  // namespace
}  // namespace karst::preflight
