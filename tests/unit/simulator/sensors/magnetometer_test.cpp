#include "plugins/simulator/sensors/magnetometer.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using sim::MagnetometerOptions;

TEST(Magnetometer, FarFromOreItReadsTheEarthsFieldInTheBodyFrame) {
  MagnetometerOptions o;
  o.noise_ut = 0;
  core::Random r(1);
  const core::Pose facing_north{Vec3::Zero(), core::from_heading(std::numbers::pi / 2)};
  const Vec3 b = sim::measure_field(o, {}, facing_north, 0, r).field_ut;
  EXPECT_LT((b - Vec3(o.north_ut, 0, -o.down_ut)).norm(), 1e-12) << b.transpose();
}

TEST(Magnetometer, ADipolesFieldOnItsAxisIsTwiceThatBesideIt) {
  const MagnetometerOptions o{0, 0, 0};
  const std::vector<cave::OreBody> ore{{{1, 2, 3}, {0, 0, 4000}}};
  // mu0 / (4 pi) = 0.1 uT m / A: 2 * 0.1 * 4000 / 2^3 on the axis, minus half of that at the equator.
  EXPECT_LT((sim::magnetic_field_ut(o, ore, {1, 2, 5}) - Vec3(0, 0, 100)).norm(), 1e-9);
  EXPECT_LT((sim::magnetic_field_ut(o, ore, {3, 2, 3}) - Vec3(0, 0, -50)).norm(), 1e-9);
}

/// Error of the heading that a level compass shows: the angle of the horizontal field from north.
double heading_error_deg(const Vec3& field_ut) {
  return std::atan2(field_ut.x(), field_ut.y()) * 180 / std::numbers::pi;
}

TEST(Magnetometer, OreBesideTheWayBendsTheHeadingAsTheClosedFormSays) {
  MagnetometerOptions o;
  o.noise_ut = 0;
  // East of a dipole that points up, level with it, its field has no horizontal part; east of one that points
  // east it adds 2 mu0 m / (4 pi r^3) eastwards to the 20.5 uT northwards.
  constexpr double kMoment = 5000;
  const std::vector<cave::OreBody> upright{{Vec3::Zero(), {0, 0, kMoment}}},
      eastward{{Vec3::Zero(), {kMoment, 0, 0}}};
  for (const double r : {2.5, 3.0, 4.0, 6.0, 12.0}) {
    EXPECT_NEAR(heading_error_deg(sim::magnetic_field_ut(o, upright, {r, 0, 0})), 0, 1e-9);
    const double expected = std::atan2(2 * 0.1 * kMoment / (r * r * r), o.north_ut) * 180 / std::numbers::pi;
    core::Random random(1);
    const core::Pose level{{r, 0, 0}, core::from_heading(std::numbers::pi / 2)};  // body x north, y west
    const Vec3 b = sim::measure_field(o, eastward, level, 0, random).field_ut;
    EXPECT_NEAR(heading_error_deg({-b.y(), b.x(), b.z()}), expected, 1e-9) << r;
  }
  // 60 degrees where the ore's field is tan(60 deg) times the earth's.
  const double r60 = std::cbrt(2 * 0.1 * kMoment / (std::tan(std::numbers::pi / 3) * o.north_ut));
  EXPECT_NEAR(heading_error_deg(sim::magnetic_field_ut(o, eastward, {r60, 0, 0})), 60, 1e-6);
  EXPECT_NEAR(r60, 3.04, 0.01) << "m from 5 kA m^2";
  EXPECT_LT(heading_error_deg(sim::magnetic_field_ut(o, eastward, {12, 0, 0})), 2);
}

TEST(Magnetometer, ADipolesFieldHasNoDivergence) {
  const MagnetometerOptions o{0, 0, 0};
  const std::vector<cave::OreBody> ore{{Vec3::Zero(), {1000, -500, 2000}}};
  core::Random r(5);
  for (int i = 0; i < 50; ++i) {
    const Vec3 p = random_unit(r) * r.uniform(1, 4);
    constexpr double h = 1e-4;
    double divergence = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 d = h * Vec3::Unit(k);
      divergence +=
          (sim::magnetic_field_ut(o, ore, p + d) - sim::magnetic_field_ut(o, ore, p - d))[k] / (2 * h);
    }
    EXPECT_NEAR(divergence, 0, 1e-3);
  }
}

}  // namespace
}  // namespace karst::test
