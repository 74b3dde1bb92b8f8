#include "plugins/simulator/sensors/lidar.h"

#include "tests/unit/simulator/meshes.h"
#include "tests/unit/simulator/sensors/exact_lidar.h"

namespace karst::test {
namespace {

using core::LidarScan;
using core::Pose;
using sim::Lidar;
using sim::LidarOptions;
using sim::PoseTrack;

/// Range from a point inside an axis-parallel box to its wall: the slab method.
double range_in_box(const Vec3& lo, const Vec3& hi, const Vec3& from, const Vec3& d) {
  double range = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
    if (d[k] != 0) range = std::min(range, ((d[k] > 0 ? hi[k] : lo[k]) - from[k]) / d[k]);
  return range;
}

const Vec3 kLow(-6, -4, -2), kHigh(9, 5, 3);

class LidarUnits : public testing::TestWithParam<const char*> {};

TEST_P(LidarUnits, RangesInABoxAreTheClosedForm) {
  const cave::Cave box = make_cave(box_mesh(kLow, kHigh));
  const Lidar lidar(exact(GetParam(), 256));
  const Pose pose{{1, -1, 0.5}, core::from_heading(0.4) * core::Quat(Eigen::AngleAxisd(0.1, Vec3::UnitX()))};
  const LidarScan scan = lidar.sweep(box, {{0, pose}, {kEnd, pose}}, kEnd, core::Random(1));
  const Pose T_world_lidar = pose * lidar.model()->T_body_lidar;
  ASSERT_EQ(scan.range_m.size(), static_cast<std::size_t>(256 * lidar.model()->channels()));
  EXPECT_EQ(scan.stamp, kEnd);
  for (int c = 0; c < lidar.model()->channels(); ++c)
    for (int j = 0; j < 256; ++j) {
      const Vec3 d = T_world_lidar.orientation * lidar.model()->direction(c, j).cast<double>();
      const double expected = range_in_box(kLow, kHigh, T_world_lidar.position, d);
      ASSERT_NEAR(scan.range_m[static_cast<std::size_t>(c * 256 + j)], expected, 6e-4)
          << c << " " << j;  // whole millimetres
    }
}
INSTANTIATE_TEST_SUITE_P(All, LidarUnits,
                         testing::Values("vlp16", "os0_32", "os0_64", "os1_64", "os0_128", "xt32"));

// From Hesai's data sheet: 32 channels a degree apart, from 15 degrees up to 16 down.
TEST(Lidar, TheXt32SeesADegreeFartherDownThanUp) {
  const auto m = sim::lidar_model(exact("xt32", 2000));
  ASSERT_EQ(m->channels(), 32);
  for (int c = 0; c < 32; ++c)
    EXPECT_NEAR(m->elevation_rad[static_cast<std::size_t>(c)] * 180 / std::numbers::pi, 15 - c, 1e-4);
}

TEST(Lidar, TheMid360ScattersTwentyThousandPointsOverItsFieldOfView) {
  const cave::Cave box = make_cave(box_mesh(kLow, kHigh));
  const Lidar lidar(exact("mid360", 256));
  EXPECT_FALSE(lidar.model()->has_rings());
  const Pose pose{{1, -1, 0.5}, core::from_heading(0.4)};
  const LidarScan scan = lidar.sweep(box, {{0, pose}, {kEnd, pose}}, kEnd, core::Random(1));
  ASSERT_TRUE(scan.fits_model());
  ASSERT_EQ(scan.range_m.size(), 20000u);  // all in reach
  const Pose T_world_lidar = pose * lidar.model()->T_body_lidar;
  std::vector<int> around(36), above(6);
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    const Vec3 d = scan.direction[i].cast<double>();
    ASSERT_NEAR(scan.range_m[i],
                range_in_box(kLow, kHigh, T_world_lidar.position, T_world_lidar.orientation * d), 6e-4);
    EXPECT_NEAR(scan.time_s[i], -0.1 + 5e-6 * static_cast<double>(i), 1e-8);
    const double elevation_deg = std::asin(d.z()) * 180 / std::numbers::pi;
    ASSERT_GE(elevation_deg, -7.001);
    ASSERT_LE(elevation_deg, 52.001);
    ++around[static_cast<std::size_t>((std::atan2(d.y(), d.x()) + std::numbers::pi) / (2 * std::numbers::pi) *
                                      35.999)];
    ++above[static_cast<std::size_t>((elevation_deg + 7.01) / 59.02 * 6)];
  }
  for (const int n : around) EXPECT_NEAR(n, 20000 / 36.0, 60);
  for (const int n : above) EXPECT_GT(n, 1000);  // the pattern is thinner at its borders
  // It does not repeat: the next sweep looks elsewhere.
  const LidarScan next = lidar.sweep(box, {{0, pose}, {2 * kEnd, pose}}, 2 * kEnd, core::Random(1));
  int same = 0;
  for (std::size_t i = 0; i < 20000; ++i) same += (scan.direction[i] - next.direction[i]).norm() < 0.002f;
  EXPECT_LT(same, 200);
}

// 125 ms are 25,000 shots of 5 us: the last batch of 16 has 8. The others belonged to the next sweep.
TEST(Lidar, ASweepOfTheMid360EndsWithItsPeriodWhateverItsBatches) {
  const cave::Cave box = make_cave(box_mesh(kLow, kHigh));
  LidarOptions o = exact("mid360", 256);
  o.rate_hz = 8;
  const Lidar lidar(o);
  const core::TimeNs end = 125 * core::kMillisecond;
  ASSERT_EQ(lidar.model()->period, end);
  const LidarScan scan = lidar.sweep(box, {{0, {}}, {end, {}}}, end, core::Random(1));
  ASSERT_EQ(scan.range_m.size(), 25000u);
  EXPECT_NEAR(scan.time_s.front(), -0.125, 1e-8);
  EXPECT_NEAR(scan.time_s.back(), -5e-6, 1e-8);
}

// 40 m at 10 %, 70 m at 80 %: the data sheet of the Mid-360. Light falls with the square of the range.
TEST(Lidar, TheMid360SeesDarkRockLessFar) {
  for (const auto& [reflectivity, range_m] :
       {std::pair{0.1, 40.0}, std::pair{0.05, 28.28}, std::pair{0.8, 70.0}}) {
    cave::Cave hall = make_cave(box_mesh({-200, -200, -200}, {range_m * 0.97, 200, 200}));
    hall.description.reflectivity = reflectivity;
    const auto ahead = [&](const cave::Cave& cave) {
      int n = 0;
      const LidarScan scan = Lidar(exact("mid360", 256)).sweep(cave, {{0, {}}}, kEnd, core::Random(1));
      for (const Vec3f& d : scan.direction) n += d.x() > 0.9999f;
      return n;
    };
    EXPECT_GT(ahead(hall), 0) << reflectivity;
    cave::Cave farther = make_cave(box_mesh({-200, -200, -200}, {range_m * 1.03, 200, 200}));
    farther.description.reflectivity = reflectivity;
    EXPECT_EQ(ahead(farther), 0) << reflectivity;
  }
}

TEST(Lidar, UnitsHaveTheirChannelsAndFieldOfView) {
  const auto check = [](const char* unit, int channels, double half_fov_deg) {
    const auto m = sim::lidar_model(exact(unit, 256));
    EXPECT_EQ(m->channels(), channels);
    EXPECT_NEAR(m->elevation_rad.front() * 180 / std::numbers::pi, half_fov_deg, 1e-4);
    EXPECT_NEAR(m->elevation_rad.back() * 180 / std::numbers::pi, -half_fov_deg, 1e-4);
  };
  check("vlp16", 16, 15);
  check("os0_32", 32, 45);
  check("os0_64", 64, 45);
  check("os1_64", 64, 22.5);
  check("os0_128", 128, 45);
}

TEST(Lidar, A64ChannelUnitOf1024ColumnsGivesItsPoints) {
  const cave::Cave box = make_cave(box_mesh(kLow, kHigh));
  for (const char* unit : {"os0_64", "os1_64"}) {
    const LidarScan scan = Lidar(exact(unit, 1024)).sweep(box, {{0, {}}}, kEnd, core::Random(1));
    EXPECT_EQ(scan.range_m.size(), 65536u);
    EXPECT_EQ(scan.model->columns, 1024);
    for (const float r : scan.range_m) ASSERT_TRUE(std::isfinite(r));
  }
}

TEST(Lidar, ASweepFromAMovingVehicleIsDistortedColumnByColumn) {
  const cave::Cave box = make_cave(box_mesh(kLow, kHigh));
  const Lidar lidar(exact("vlp16", 256));
  // 3 m/s and a turn of 2 rad/s over the sweep, tracked every 5 ms.
  const auto pose_of = [](double t) { return Pose{Vec3(3 * t, -1 * t, 0.2), core::from_heading(2 * t)}; };
  PoseTrack track;
  for (int i = 0; i <= 20; ++i) track.push_back({i * 5 * core::kMillisecond, pose_of(i * 0.005)});
  const LidarScan scan = lidar.sweep(box, track, kEnd, core::Random(1));
  double largest_distortion = 0;
  for (int j = 0; j < 256; ++j) {
    const Pose fired = pose_of(0.1 * (j + 1) / 256) * lidar.model()->T_body_lidar;
    const Pose still = pose_of(0.1) * lidar.model()->T_body_lidar;
    const Vec3 beam = lidar.model()->direction(7, j).cast<double>();
    const double measured = scan.range_m[static_cast<std::size_t>(7 * 256 + j)];
    ASSERT_NEAR(measured, range_in_box(kLow, kHigh, fired.position, fired.orientation * beam), 7e-4);
    largest_distortion =
        std::max(largest_distortion,
                 std::abs(measured - range_in_box(kLow, kHigh, still.position, still.orientation * beam)));
  }
  EXPECT_GT(largest_distortion, 0.3) << "without the motion the picture is another";
}

TEST(Lidar, NoiseHasItsDeviation) {
  const cave::Cave box = make_cave(box_mesh(kLow, kHigh));
  LidarOptions o = exact("os1_64", 1024);
  const LidarScan truth = Lidar(o).sweep(box, {{0, {}}}, kEnd, core::Random(1));
  o.noise_m = 0.02;
  const LidarScan noisy = Lidar(o).sweep(box, {{0, {}}}, kEnd, core::Random(1));
  double mean = 0, square = 0;
  const auto n = static_cast<double>(truth.range_m.size());
  for (std::size_t i = 0; i < truth.range_m.size(); ++i) {
    const double e = noisy.range_m[i] - truth.range_m[i];
    mean += e / n, square += e * e / n;
  }
  EXPECT_NEAR(mean, 0, 4e-4);
  EXPECT_NEAR(std::sqrt(square), 0.02, 4e-4);
}

TEST(Lidar, BeyondReachIsInfiniteAndTooNearIsNoMeasurement) {
  const cave::Cave far = make_cave(box_mesh({-200, -200, -200}, {200, 200, 200}));
  for (const float r : Lidar(exact("vlp16", 256)).sweep(far, {{0, {}}}, kEnd, core::Random(1)).range_m)
    ASSERT_TRUE(std::isinf(r));
  const cave::Cave near = make_cave(box_mesh({-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}));
  const LidarScan scan = Lidar(exact("vlp16", 256)).sweep(near, {{0, {}}}, kEnd, core::Random(1));
  EXPECT_TRUE(std::isnan(scan.range_m[7 * 256])) << "straight backwards, 0.2 m";
}

TEST(Lidar, IntensityFallsWithRangeIncidenceAndReflectivity) {
  EXPECT_NEAR(sim::return_intensity(0.5, 1, 25), 0.25, 1e-6);
  EXPECT_LT(sim::return_intensity(0.5, 1, 10), sim::return_intensity(0.5, 1, 5));
  EXPECT_LT(sim::return_intensity(0.5, 0.3f, 5), sim::return_intensity(0.5, 1, 5));
  EXPECT_LT(sim::return_intensity(0.1, 1, 5), sim::return_intensity(0.5, 1, 5));

  cave::Cave box = make_cave(box_mesh(kLow, kHigh));
  box.description.patches.push_back({{9, 0, 0}, 3, 0.05});  // wet rock ahead
  const LidarScan scan = Lidar(exact("vlp16", 256)).sweep(box, {{0, {}}}, kEnd, core::Random(1));
  const auto at = [&](int column) { return scan.intensity[static_cast<std::size_t>(7 * 256 + column)]; };
  EXPECT_NEAR(at(128), sim::return_intensity(0.05, 1, 9), 1e-3);
  EXPECT_NEAR(at(0), sim::return_intensity(0.5, 1, 6), 1e-2);
}

TEST(Lidar, DustIsNearDimAndAsFrequentAsAsked) {
  const cave::Cave box = make_cave(box_mesh(kLow, kHigh));
  LidarOptions o = exact("os1_64", 1024);
  o.dust_fraction = 0.05;
  const LidarScan scan = Lidar(o).sweep(box, {{0, {}}}, kEnd, core::Random(1));
  int dust = 0;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    if (scan.intensity[i] > 0.02f) continue;
    ++dust;
    ASSERT_LE(scan.range_m[i], 3.0f + 1e-6f);
  }
  EXPECT_NEAR(dust / static_cast<double>(scan.range_m.size()), 0.05, 0.005);
}

TEST(PoseTrack, KeepsWhatASweepNeedsAndInterpolates) {
  PoseTrack track;
  for (int i = 0; i <= 100; ++i)
    sim::append(track, {i * 10, {Vec3(i, 0, 0), core::from_heading(0.01 * i)}}, i * 10 - 55);
  EXPECT_EQ(track.front().stamp, 940) << "the last from before 945";
  EXPECT_NEAR(sim::pose_at(track, 977).position.x(), 97.7, 1e-12);
  EXPECT_NEAR(core::heading_of(sim::pose_at(track, 977).orientation), 0.977, 1e-9);
  EXPECT_EQ(sim::pose_at(track, 0).position.x(), 94);
  EXPECT_EQ(sim::pose_at(track, 5000).position.x(), 100);
}

}  // namespace
}  // namespace karst::test
