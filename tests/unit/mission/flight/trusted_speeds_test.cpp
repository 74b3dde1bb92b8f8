#include "core_stack/mission/flight/trusted_speeds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/unit/mission/lidar_vehicle.h"

namespace karst::core {
namespace {

void set(VoxelMap& map, const Vec3& low, const Vec3& high, float log_odds) {
  const CellKey from = map.key_of(low), to = map.key_of(high);
  for (std::int32_t z = from.z; z <= to.z; ++z)
    for (std::int32_t y = from.y; y <= to.y; ++y)
      for (std::int32_t x = from.x; x <= to.x; ++x) map.assign({x, y, z}, 1, log_odds);
}

/// Two straight passages of 30 m with a right angle between them, known and free.
VoxelMap bent_passage(double half_width_m) {
  VoxelMap map{MapOptions{}};
  const double w = half_width_m - 0.05;
  set(map, {-5, -w, -w}, {30 + w, w, w}, -1);
  set(map, {30 - w, -w, -w}, {30 + w, 30, w}, -1);
  return map;
}

CoreOptions fast() {
  CoreOptions o;
  o.motion.max_speed_mps = 6;
  o.localization.source = PoseSource::pose_sensor;
  return o;
}

constexpr double kBraking_mps2 = 2;
const std::vector<Vec3> kAround{{0, 0, 0}, {30, 0, 0}, {30, 25, 0}};

TEST(TrustedSpeeds, AMissionOfTwoMetresPerSecondHasNone) {
  CoreOptions o = fast();
  o.motion.max_speed_mps = 2;
  const TrustedSpeeds t = trusted_speeds(bent_passage(3), o, with_lidar(), kAround, kBraking_mps2);
  EXPECT_TRUE(t.sight_mps.empty());
  EXPECT_TRUE(t.room_mps.empty());
}

TEST(TrustedSpeeds, TheReactionCountsTheScansThatAFreeCellTakesToBecomeRock) {
  CoreOptions o = fast();
  // From 0.12 by hits of 0.75: log-odds -1.99, -0.89, 0.20. Two scans, and one that just missed it.
  EXPECT_NEAR(sensed_ahead(o, with_lidar()).reaction_s, 3 * 0.1 + 0.06 + 2.0 / 24, 1e-9);
  o.localization.source = PoseSource::lidar;
  EXPECT_NEAR(sensed_ahead(o, with_lidar()).reaction_s, 3 * 0.1 + 0.06 + 2.0 / 24 + 0.08, 1e-9);
  EXPECT_EQ(sensed_ahead(o, with_lidar()).range_m(), o.mission.mapping_range_m);
}

TEST(TrustedSpeeds, BeforeABendTheWayInSightSetsTheSpeed) {
  const CoreOptions o = fast();
  const VehicleDescription v = with_lidar();
  const TrustedSpeeds t = trusted_speeds(bent_passage(3), o, v, kAround, kBraking_mps2);
  const double reaction_s = sensed_ahead(o, v).reaction_s,
               open_mps = open_space_speed_mps(o, sensed_ahead(o, v), 2);
  const auto speed_mps = [&](double seen_m) {
    return stopping_speed_mps(seen_m - o.planning.clearance_m, reaction_s, kBraking_mps2);
  };
  // From (x, 0) past the inner corner at (27, 3), one sees y up to 3 (30 - x) / (27 - x) of the passage
  // beyond.
  for (const double x : {5.0, 10.0, 15.0, 20.0, 24.0}) {
    const double beyond_m = 3 * (30.48 - x) / (27 - x), seen_m = 30 - x + std::min(25.0, beyond_m);
    EXPECT_NEAR(t.sight_at_mps(25 + 30 - x), std::min(open_mps, speed_mps(seen_m)), 0.35) << x;
  }
  EXPECT_EQ(t.sight_at_mps(20), open_mps) << "the end is in sight";
  for (const double mps : t.sight_mps) EXPECT_GE(mps, kTrusted_mps);
}

TEST(TrustedSpeeds, NearRockTheGapOfTheHullSetsTheSpeed) {
  const CoreOptions o = fast();
  const VehicleDescription v = with_lidar();
  // The middle of 2 m is 1.1 m from the first cells' centres: a gap of 1.1 - 0.3 - 0.1 m.
  const TrustedSpeeds wide = trusted_speeds(bent_passage(1), o, v, {{0, 0, 0}, {20, 0, 0}}, kBraking_mps2);
  EXPECT_TRUE(std::isinf(wide.room_at_mps(10)));
  const TrustedSpeeds beside =
      trusted_speeds(bent_passage(1), o, v, {{0, -0.3, 0.1}, {20, -0.3, 0.1}}, kBraking_mps2);
  EXPECT_NEAR(beside.room_at_mps(10), 4.0, 0.1) << "a gap of 0.4 m; centres lie up to 0.1 m along the path";
  const TrustedSpeeds close =
      trusted_speeds(bent_passage(1), o, v, {{0, -0.7, 0.1}, {20, -0.7, 0.1}}, kBraking_mps2);
  EXPECT_EQ(close.room_at_mps(10), kTrusted_mps);
}

TEST(TrustedSpeeds, StraightUpALidarSeesNothing) {
  VoxelMap map{MapOptions{}};
  set(map, {-3, -3, -3}, {3, 3, 40}, -1);
  const CoreOptions o = fast();
  const TrustedSpeeds t = trusted_speeds(map, o, with_lidar(), {{0, 0, 0}, {0, 0, 30}}, kBraking_mps2);
  EXPECT_EQ(t.sight_at_mps(15), kTrusted_mps);
}

TEST(TrustedSpeeds, ACameraOfShortRangeLimitsOpenSpaceToo) {
  CoreOptions o = fast();
  VehicleDescription v;
  auto camera = std::make_shared<CameraModel>();
  camera->horizontal_fov_rad = camera->vertical_fov_rad = 1;
  v.cameras = {camera};
  const SensedAhead sensed = sensed_ahead(o, v);
  EXPECT_DOUBLE_EQ(open_space_speed_mps(o, sensed, kBraking_mps2),
                   stopping_speed_mps(4.5 - o.planning.clearance_m, sensed.reaction_s, kBraking_mps2));
  EXPECT_EQ(open_space_speed_mps(o, sensed, 0.3), kTrusted_mps);
}

// As they were: a camera that looks back, and any camera of a vehicle that does not turn to where it flies.
TEST(TrustedSpeeds, OnlySensorsThatLookAheadCount) {
  const CoreOptions o = fast();
  const auto with_camera = [](const Quat& orientation) {
    VehicleDescription v;
    auto camera = std::make_shared<CameraModel>();
    camera->horizontal_fov_rad = camera->vertical_fov_rad = 1;
    camera->T_body_camera.orientation = orientation;
    v.cameras = {camera};
    return v;
  };
  const auto turned = [](double angle_rad, const Vec3& axis) {
    return Quat(Eigen::AngleAxisd(angle_rad, axis));
  };
  EXPECT_GT(sensed_ahead(o, with_camera(Quat::Identity())).range_m(), 4);
  EXPECT_EQ(sensed_ahead(o, with_camera(turned(std::numbers::pi, Vec3::UnitZ()))).range_m(), 0);
  EXPECT_EQ(sensed_ahead(o, with_camera(turned(std::numbers::pi / 2, Vec3::UnitY()))).range_m(), 0)
      << "it looks down";
  VehicleDescription both = with_camera(Quat::Identity());
  both.lidar = with_lidar().lidar;
  EXPECT_EQ(sensed_ahead(o, both).bands.size(), 1u);
}

TEST(TrustedSpeeds, ATiltedLidarCountsForWhatItSeesAllAround) {
  const CoreOptions o = fast();
  const auto band_of = [&](double tilt_rad) {
    LidarModel lidar = *with_lidar().lidar;
    lidar.T_body_lidar.orientation = Quat(Eigen::AngleAxisd(tilt_rad, Vec3::UnitX()));
    lidar.elevation_rad = {0.5f, -0.3f};
    VehicleDescription v;
    v.lidar = std::make_shared<LidarModel>(lidar);
    const SensedAhead sensed = sensed_ahead(o, v);
    return sensed.bands.empty() ? std::pair(1.0, -1.0)
                                : std::pair(sensed.bands[0].low_rad, sensed.bands[0].high_rad);
  };
  EXPECT_NEAR(band_of(0.1).first, -0.2, 1e-6);
  EXPECT_NEAR(band_of(0.1).second, 0.4, 1e-6);
  EXPECT_NEAR(band_of(std::numbers::pi).first, -0.5, 1e-6) << "it hangs";
  EXPECT_NEAR(band_of(std::numbers::pi).second, 0.3, 1e-6);
  EXPECT_GT(band_of(std::numbers::pi / 2).first, band_of(std::numbers::pi / 2).second)
      << "nothing is seen all around";
}

// As it was: half of 6 m/s in a passage of 1.1 m, 1 mm from rock.
TEST(TrustedSpeeds, NarrowPlacesAreFlownNoFasterThanByAVehicleOfTwoMetresPerSecond) {
  CoreOptions o = fast();
  EXPECT_DOUBLE_EQ(slow_speed_mps(o), 0.5 * kTrusted_mps);
  o.motion.max_speed_mps = 1;
  EXPECT_DOUBLE_EQ(slow_speed_mps(o), 0.5);
}

TEST(TrustedSpeeds, TheMissionKnowsWhatTheVehicleCanReach) {
  CoreOptions o = fast();
  VehicleDescription blind;
  EXPECT_EQ(as_flown(o, blind).motion.max_speed_mps, kTrusted_mps);
  EXPECT_EQ(as_flown(o, with_lidar()).motion.max_speed_mps, 6);
  o.motion.max_speed_mps = 1.5;
  EXPECT_EQ(as_flown(o, blind).motion.max_speed_mps, 1.5);
}

TEST(TrustedSpeeds, WhereTheyApplyTrajectoriesAreSampled) {
  CoreOptions o = fast();
  for (const TrajectoryKind kind : {TrajectoryKind::horizon, TrajectoryKind::polynomial}) {
    o.motion.trajectory = kind;
    o.motion.max_speed_mps = 2;
    EXPECT_EQ(as_flown(o, with_lidar()).motion.trajectory, kind);
    o.motion.max_speed_mps = 2.1;
    EXPECT_EQ(as_flown(o, with_lidar()).motion.trajectory, TrajectoryKind::sampled);
  }
}

}  // namespace
}  // namespace karst::core
