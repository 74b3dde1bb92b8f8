#include "core_stack/localization/sweep.h"

#include <gtest/gtest.h>

#include "tests/unit/localization/worlds.h"

namespace {

using namespace karst::core;
using namespace karst::test;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

TEST(Sweep, PointsLieWhereTheModelsBeamsPointAndCarryTheTimeOfTheirColumn) {
  const auto model = lidar(5, 16);
  LidarScan scan{kSecond, model, std::vector<float>(80, 7.0f), std::vector<float>(80, 0.25f)};
  const Sweep sweep = to_sweep(scan, 0.3);
  ASSERT_EQ(sweep.points.size(), 80u);
  EXPECT_EQ(sweep.stamp, kSecond);
  EXPECT_EQ(sweep.T_body_lidar.position, model->T_body_lidar.position);
  EXPECT_FALSE(sweep.compensated);
  for (std::size_t i = 0; i < 80; ++i) {
    const int ring = static_cast<int>(i) / 16, column = static_cast<int>(i) % 16;
    EXPECT_EQ(sweep.points[i].ring, ring);
    EXPECT_LT((sweep.points[i].position - 7 * model->direction(ring, column)).norm(), 1e-5f);
    EXPECT_NEAR(sweep.points[i].time_s, -0.1 + 0.1 * (column + 1) / 16, 1e-7);
    EXPECT_EQ(sweep.points[i].intensity, 0.25f);
  }
}

// The model's own beams are the reference: origin, offset of the channel, time of the column.
TEST(Sweep, UnevenBeamsLeaveOffTheAxisAtTheirOwnAzimuthsAndTimes) {
  const auto model = lidar(3, 8);
  model->azimuth_offset_rad = {0.2f, -0.1f, 0.05f};
  model->beam_origin_m = 0.03f;
  LidarScan scan{kSecond, model, std::vector<float>(24, 4.0f), {}};
  for (int j = 0; j < 8; ++j) scan.time_s.push_back(-0.01f * static_cast<float>(8 - j));
  const Sweep sweep = to_sweep(scan, 0.3);
  ASSERT_EQ(sweep.points.size(), 24u);
  EXPECT_TRUE(sweep.has_rings);
  for (std::size_t i = 0; i < 24; ++i) {
    const int ring = static_cast<int>(i) / 8, column = static_cast<int>(i) % 8;
    EXPECT_LT((sweep.points[i].position - model->origin(column) - 4 * model->direction(ring, column)).norm(),
              1e-6f);
    EXPECT_EQ(sweep.points[i].time_s, scan.time_s[i % 8]);
  }
  const double turned = std::atan2(model->direction(0, 3).y(), model->direction(0, 3).x());
  EXPECT_NEAR(turned, std::numbers::pi * (1 - 2 * 3.5 / 8) + 0.2, 1e-6);
  EXPECT_LT((model->origin(3) - 0.03f * Vec3f(std::cos(std::numbers::pi_v<float> / 8),
                                              std::sin(std::numbers::pi_v<float> / 8), 0))
                .norm(),
            1e-7f);
}

TEST(Sweep, PointsWithoutRingsKeepTheirOwnDirectionsAndTimes) {
  const auto model = lidar(2, 0);
  LidarScan scan{kSecond, model, {5, kNan, 0.1f, 7}, {}};
  scan.direction = {Vec3f::UnitX(), Vec3f::UnitY(), Vec3f::UnitZ(), -Vec3f::UnitY()};
  scan.time_s = {-0.09f, -0.05f, -0.02f, 0};
  const Sweep sweep = to_sweep(scan, 0.5);
  EXPECT_FALSE(sweep.has_rings);
  ASSERT_EQ(sweep.points.size(), 2u);
  EXPECT_EQ(sweep.points[0].position, Vec3f(5, 0, 0));
  EXPECT_EQ(sweep.points[0].time_s, -0.09f);
  EXPECT_EQ(sweep.points[1].position, Vec3f(0, -7, 0));
  scan.direction.pop_back();
  EXPECT_TRUE(to_sweep(scan, 0.5).points.empty());
}

TEST(Sweep, NoReturnsAndReturnsOffTheVehicleAreDropped) {
  const auto model = lidar(2, 4);
  LidarScan scan{0, model, {1, kNan, kInf, -kInf, 0.2f, 5, 0, -1}, std::vector<float>(8)};
  const Sweep sweep = to_sweep(scan, 0.5);
  ASSERT_EQ(sweep.points.size(), 2u);
  EXPECT_NEAR(sweep.points[0].position.norm(), 1, 1e-6);
  EXPECT_NEAR(sweep.points[1].position.norm(), 5, 1e-6);
}

TEST(Sweep, ArraysThatDoNotFitTheModelGiveNoPoints) {
  EXPECT_TRUE(to_sweep(LidarScan{}, 0.3).points.empty());
  LidarScan scan{0, lidar(2, 4), std::vector<float>(7, 5.0f), {}};
  EXPECT_TRUE(to_sweep(scan, 0.3).points.empty());
  scan.range_m.resize(8, 5.0f);  // intensities may be missing
  EXPECT_EQ(to_sweep(scan, 0.3).points.size(), 8u);
}

}  // namespace
