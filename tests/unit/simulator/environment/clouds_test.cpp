#include "plugins/simulator/environment/clouds.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "plugins/simulator/sensors/lidar.h"
#include "tests/unit/simulator/meshes.h"
#include "tests/unit/simulator/sensors/exact_lidar.h"

namespace karst::test {
namespace {

using sim::Air;
using sim::CloudyPath;

cave::Cloud ball(const Vec3& p, double radius_m, double extinction_1pm,
                 double lidar_ratio_sr = cave::Cloud::kDroplets_sr) {
  cave::Cloud c;
  c.position = p;
  c.half_size_m.setConstant(radius_m);
  c.extinction_1pm = extinction_1pm;
  c.lidar_ratio_sr = lidar_ratio_sr;
  return c;
}

cave::Cloud box(const Vec3& p, const Vec3& half_size_m, double extinction_1pm) {
  cave::Cloud c = ball(p, 1, extinction_1pm);
  c.box = true;
  c.half_size_m = half_size_m;
  return c;
}

bool inside(const cave::Cloud& c, const Vec3& p) {
  const Vec3 o = p - c.position;
  return c.box ? (o.cwiseAbs() - c.half_size_m).maxCoeff() < 0 : o.norm() < c.half_size_m.x();
}

/// The sum over small steps is the oracle of the closed forms.
RC_GTEST_PROP(Clouds, OpticalDepthIsTheIntegralOfExtinctionAlongTheBeam, ()) {
  const auto number = [](double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 10000) / 10000.0;
  };
  const std::vector<cave::Cloud> clouds{
      ball({number(-4, 4), number(-4, 4), 0}, number(0.3, 3), number(0.05, 2)),
      box({number(-4, 4), number(-4, 4), 0.5}, {number(0.3, 3), number(0.3, 3), number(0.3, 3)}, 0.4),
      ball({1, 1, 0}, 2, 0.2)};
  const Vec3 from(number(-5, 5), number(-5, 5), number(-1, 1));
  const Vec3 towards = Vec3(number(-1, 1), number(-1, 1), number(-0.3, 0.3)) + Vec3(0, 0, 1e-3);
  RC_PRE(towards.norm() > 0.05);
  const cave::Ray ray{from.cast<float>(), towards.normalized().cast<float>()};
  CloudyPath path;
  path.trace(clouds, ray);
  double sum = 0;
  constexpr double kStep_m = 1e-3;
  for (double t = kStep_m / 2; t < 8; t += kStep_m)
    for (const cave::Cloud& c : clouds)
      if (inside(c, from + t * towards.normalized())) sum += kStep_m * c.extinction_1pm;
  RC_ASSERT(std::abs(path.depth(8) - sum) < 0.02);
  double stretches = 0;
  path.for_each_stretch(0, 8, 0.75, [&](const CloudyPath::Stretch& s) {
    stretches += s.depth;
    RC_ASSERT(s.to_m >= s.from_m && s.from_m >= 0 && s.to_m <= 8.0);
  });
  RC_ASSERT(std::abs(stretches - std::min(path.depth(8), stretches)) < 1e-9);
  RC_ASSERT(path.depth(8) > 8 || std::abs(stretches - path.depth(8)) < 1e-9);
}

TEST(Clouds, WhatComesBackOfAllStretchesIsWhatTheWholeCloudSendsBack) {
  CloudyPath path;
  const std::vector<cave::Cloud> cloud{ball({5, 0, 0}, 2, 0.3)};
  path.trace(cloud, {Vec3f::Zero(), Vec3f::UnitX()});
  for (const double length_m : {0.1, 0.75, 3.0}) {
    double back = 0;
    path.for_each_stretch(0.3, 20, length_m, [&](const CloudyPath::Stretch& s) { back += s.mean_echo; });
    EXPECT_NEAR(back, std::numbers::pi / 2 / 18.8 * (1 - std::exp(-2 * 0.3 * 4)), 1e-9) << length_m;
  }
  EXPECT_NEAR(path.two_way(20), std::exp(-2 * 0.3 * 4), 1e-9);
  EXPECT_NEAR(path.two_way(5), std::exp(-2 * 0.3 * 2), 1e-9);
  EXPECT_EQ(path.two_way(3), 1);
}

TEST(Clouds, EchoesAreDistributedExponentiallyAndComeFromTheNearEndMostly) {
  const CloudyPath::Stretch s{2, 3, 1.5, 0.02};
  core::Random random(4);
  constexpr int kDraws = 40000;
  int above_mean = 0, above_three = 0;
  double place = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double e = s.echo(random);
    above_mean += e > 0.02, above_three += e > 0.06;
    const double m = s.place_m(random);
    ASSERT_TRUE(m >= 2 && m <= 3);
    place += m / kDraws;
  }
  EXPECT_NEAR(above_mean / double(kDraws), std::exp(-1), 0.01);
  EXPECT_NEAR(above_three / double(kDraws), std::exp(-3), 0.005);
  // Mean of the density 3 exp(-3 x) / (1 - exp(-3)) on [0, 1].
  EXPECT_NEAR(place, 2 + 1 / 3.0 - std::exp(-3) / (1 - std::exp(-3)), 0.005);
}

core::LidarScan scan_of(const cave::Cave& cave, const sim::LidarOptions& o, std::vector<cave::Cloud> clouds,
                        std::uint64_t seed = 1) {
  return sim::Lidar(o).sweep(cave, {{0, {}}}, kEnd, core::Random(7),
                             Air{std::move(clouds), core::Random(seed)});
}

TEST(LidarInClouds, RockBehindACloudIsDimmedByBeerAndLambert) {
  const cave::Cave room = make_cave(box_mesh({-6, -4, -2}, {9, 5, 3}));
  const core::LidarScan clear = scan_of(room, exact("os1_64", 512), {}),
                        hazy = scan_of(room, exact("os1_64", 512), {ball({0, 0, 0.1}, 2, 0.1)});
  int compared = 0;
  for (std::size_t i = 0; i < clear.range_m.size(); ++i) {
    if (hazy.range_m[i] != clear.range_m[i]) continue;
    ASSERT_NEAR(hazy.intensity[i], clear.intensity[i] * std::exp(-2 * 0.1 * std::min(2.0f, clear.range_m[i])),
                1e-4);
    ++compared;
  }
  EXPECT_GT(compared, 0.75 * static_cast<double>(clear.range_m.size())) << "so thin it hides little";
}

TEST(LidarInClouds, ItsEchoesAreInTheCloudInFrontOfTheRockAndWeak) {
  const cave::Cave room = make_cave(box_mesh({-6, -4, -2}, {9, 5, 3}));
  const auto cloud = ball({4, 0, 0}, 1.8, 0.5);
  const auto o = exact("os1_64", 512);
  const core::LidarScan clear = scan_of(room, o, {}), dusty = scan_of(room, o, {cloud});
  const auto model = sim::lidar_model(o);
  int echoes = 0;
  double mean = 0, rock_mean = 0;
  for (std::size_t i = 0; i < clear.range_m.size(); ++i) {
    rock_mean += clear.intensity[i] / static_cast<double>(clear.range_m.size());
    if (std::isnan(dusty.range_m[i]) || dusty.range_m[i] == clear.range_m[i]) continue;
    ++echoes;
    ASSERT_LT(dusty.range_m[i], clear.range_m[i]);
    const auto beam = model->direction(static_cast<int>(i) / 512, static_cast<int>(i) % 512);
    const Vec3 p = model->T_body_lidar.position + dusty.range_m[i] * beam.cast<double>();
    ASSERT_LT((p - cloud.position).norm(), 1.8 + 6e-4);  // whole millimetres
    mean += dusty.intensity[i];
  }
  EXPECT_GT(echoes, 500);
  EXPECT_LT(mean / echoes, 0.25 * rock_mean);
}

TEST(LidarInClouds, AThinSheetOutshinesRockAsOftenAsAnExponentialExceedsTheRocksLight) {
  // A sheet across the way, thinner than a pulse, before dark rock: one stretch, one draw.
  cave::Cave room = make_cave(box_mesh({-9, -40, -40}, {14, 40, 40}));
  room.description.reflectivity = 0.02;
  const auto o = exact("os1_64", 512);
  const core::LidarScan scan = scan_of(room, o, {box({5, 0, 0}, {0.2, 60, 60}, 0.15)});
  const auto model = sim::lidar_model(o);
  double expected = 0, seen = 0, beams = 0;
  for (int c = 0; c < 64; ++c)
    for (int j = 0; j < 512; ++j) {
      const auto d = static_cast<double>(model->direction(c, j).x());
      if (d < 0.7) continue;  // so that the sheet is met once, within the length of a pulse
      const double depth = 0.15 * 0.4 / d, mean = std::numbers::pi / 2 / 18.8 * (1 - std::exp(-2 * depth));
      const double rock = 0.02 * d * std::exp(-2 * depth) / std::pow(14 / d, 2);
      expected += std::exp(-rock * std::pow(5 / d, 2) / mean);
      seen += scan.range_m[static_cast<std::size_t>(c * 512 + j)] < 5.21 / d;
      ++beams;
    }
  EXPECT_NEAR(seen, expected, 4 * std::sqrt(expected));
  EXPECT_GT(expected, 0.3 * beams);
  EXPECT_LT(expected, 0.9 * beams);
}

TEST(LidarInClouds, ABlindingCloudLeavesNoMeasurementAndClaimsNoFreeSpace) {
  const cave::Cave room = make_cave(box_mesh({-6, -4, -2}, {9, 5, 3}));
  const core::LidarScan scan = scan_of(room, exact("os0_32", 512), {ball({0, 0, 0}, 5, 3)});
  for (const float r : scan.range_m) ASSERT_TRUE(std::isnan(r) || r < 3);
  // Nothing in reach, and a cloud before it: that, too, is no measurement.
  const cave::Cave far = make_cave(box_mesh({-200, -200, -200}, {200, 200, 200}));
  for (const float r : scan_of(far, exact("os0_32", 512), {ball({0, 0, 0}, 2, 0.05)}).range_m)
    ASSERT_TRUE(std::isnan(r) || r < 2.2f);
}

TEST(LidarInClouds, SameSeedSameBytesAndBeamsBesideTheCloudAreUntouched) {
  const cave::Cave room = make_cave(box_mesh({-6, -4, -2}, {9, 5, 3}));
  auto o = exact("os0_32", 512);
  o.noise_m = 0.02;
  const auto cloud = ball({4, 0, 0}, 1.5, 0.6);
  const core::LidarScan a = scan_of(room, o, {cloud}, 1), b = scan_of(room, o, {cloud}, 1),
                        other = scan_of(room, o, {cloud}, 2), clear = scan_of(room, o, {});
  const auto bits = [](const std::vector<float>& v) {
    return std::string(reinterpret_cast<const char*>(v.data()), 4 * v.size());
  };
  EXPECT_EQ(bits(a.range_m), bits(b.range_m));
  EXPECT_EQ(bits(a.intensity), bits(b.intensity));
  EXPECT_NE(bits(a.range_m), bits(other.range_m));
  const sim::Lidar lidar(o);
  for (int c = 0; c < 32; ++c)
    for (int j = 0; j < 512; ++j) {
      const Vec3 d = lidar.model()->direction(c, j).cast<double>();
      const Vec3 at = cloud.position - lidar.model()->T_body_lidar.position;
      if (at.dot(d) > 0 && at.cross(d).norm() < 1.5) continue;
      const auto i = static_cast<std::size_t>(c * 512 + j);
      ASSERT_EQ(a.range_m[i], clear.range_m[i]);
      ASSERT_EQ(a.intensity[i], clear.intensity[i]);
    }
}

}  // namespace
}  // namespace karst::test
