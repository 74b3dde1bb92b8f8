#include "plugins/simulator/magnetometer.h"

#include "meshes.h"

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
