#include "plugins/simulator/environment/cave_air.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using sim::AirOptions;
using sim::CaveAir;

core::Pose at(const Vec3& p) { return {p, core::Quat::Identity()}; }

/// Optical extinction at a place: the sum over the clouds that hold it.
double extinction(const std::vector<cave::Cloud>& clouds, const Vec3& p) {
  double sum = 0;
  for (const cave::Cloud& c : clouds)
    if ((p - c.position).norm() < c.half_size_m.x()) sum += c.extinction_1pm;
  return sum;
}

TEST(CaveAir, IsClearUnlessAskedOtherwise) {
  CaveAir air({}, {}, 0.3);
  const cave::RayScene room(box_mesh({-5, -5, 0}, {5, 5, 4}));
  air.stir(1, at({0, 0, 0.5}), room);
  EXPECT_TRUE(air.present(2, {0, 0, 0.5}, true).empty());
}

TEST(CaveAir, TheCavesCloudsComeAtTheirTimeAndMistFliesAlong) {
  cave::Cloud late;
  late.after_s = 10;
  AirOptions o;
  o.mist_1pm = 0.2;
  const CaveAir air(o, {cave::Cloud{}, late}, 0.3);
  EXPECT_EQ(air.present(9, Vec3::Zero(), false).size(), 1u) << "no mist on the ground";
  EXPECT_EQ(air.present(10, Vec3::Zero(), false).size(), 2u);
  const auto in_flight = air.present(10, {3, 2, 1}, true);
  ASSERT_EQ(in_flight.size(), 3u);
  EXPECT_EQ(in_flight[2].position, Vec3(3, 2, 1));
  EXPECT_EQ(in_flight[2].lidar_ratio_sr, cave::Cloud::kDroplets_sr);
}

TEST(CaveAir, TheWashLiftsNothingBeyondItsReachAndAllWithinItsCore) {
  EXPECT_EQ(sim::lifted_fraction(3, 3, 0.3), 0);
  EXPECT_EQ(sim::lifted_fraction(1.5, 3, 0.3), 1) << "2.5 diameters";
  // (u^2 - u_t^2) over its value at the core's end, u = 1 / distance.
  EXPECT_NEAR(sim::lifted_fraction(2, 3, 0.3), (1 / 4.0 - 1 / 9.0) / (1 / 2.25 - 1 / 9.0), 1e-12);
  EXPECT_EQ(sim::lifted_fraction(0.5, 1, 0.3), 1);
  EXPECT_EQ(sim::lifted_fraction(1, 1, 0.3), 0);
  for (double m = 0.1; m < 4; m += 0.1)
    EXPECT_GE(sim::lifted_fraction(m, 3, 0.3), sim::lifted_fraction(m + 0.1, 3, 0.3));
}

TEST(CaveAir, DustRisesBelowAndBesideTheVehicleNearRockOnly) {
  AirOptions o;
  o.stirred_1pm = 1;
  const cave::RayScene room(box_mesh({-8, -8, 0}, {8, 8, 12}));
  const auto hover = [&](const Vec3& p) {
    CaveAir air(o, {}, 0.3);
    for (int i = 0; i < 8; ++i) air.stir(0.5 * i, at(p), room);
    return air.present(4, p, true);
  };
  EXPECT_TRUE(hover({0, 0, 6}).empty());
  EXPECT_GT(extinction(hover({0, 0, 1}), {0, 0, 0.3}), 0.8) << "puffs add up";
  EXPECT_GT(extinction(hover({0, 0, 1}), {0, 0, 0.3}), extinction(hover({0, 0, 2.5}), {0, 0, 0.3}));
  const auto wall = hover({7.2, 0, 6});
  ASSERT_FALSE(wall.empty());
  for (const auto& c : wall) EXPECT_NEAR(c.position.x(), 8, 1e-4);
}

TEST(CaveAir, PuffsSpreadThinAndSettle) {
  AirOptions o;
  o.stirred_1pm = 1;
  const cave::RayScene room(box_mesh({-8, -8, 0}, {8, 8, 12}));
  CaveAir air(o, {}, 0.3);
  air.stir(0, at({0, 0, 1}), room);
  const auto young = air.present(0.5, {0, 0, 1}, true), old = air.present(3, {0, 0, 1}, true);
  ASSERT_EQ(young.size(), 1u);
  ASSERT_EQ(old.size(), 1u);
  EXPECT_NEAR(young[0].half_size_m.x(), 1.0, 1e-12);
  EXPECT_GT(old[0].half_size_m.x(), young[0].half_size_m.x());
  // What floats in it only gets less.
  const auto mass = [](const cave::Cloud& c) { return c.extinction_1pm * std::pow(c.half_size_m.x(), 3); };
  EXPECT_NEAR(mass(old[0]) / mass(young[0]), std::exp(-2.5 / o.settling_s), 1e-9);
  EXPECT_TRUE(air.present(60, {0, 0, 1}, true).empty());
}

}  // namespace
}  // namespace karst::test
