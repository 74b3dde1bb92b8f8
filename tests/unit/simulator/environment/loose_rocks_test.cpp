#include "plugins/simulator/environment/loose_rocks.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using sim::LooseRocks;

cave::LooseRock rock_at(const Vec3& p) {
  cave::LooseRock b;
  b.position = b.to = p;
  return b;
}

TEST(LooseRocks, ComeAtTheirTimeAndStay) {
  cave::LooseRock b = rock_at({5, 0, 0});
  b.after_s = 10;
  LooseRocks boulders({b});
  EXPECT_FALSE(boulders.advance(9.9, Vec3::Zero()));
  EXPECT_TRUE(boulders.present().empty());
  EXPECT_TRUE(boulders.advance(10, Vec3::Zero()));
  EXPECT_FALSE(boulders.advance(11, Vec3::Zero()));
  ASSERT_EQ(boulders.present().size(), 1u);
  EXPECT_EQ(boulders.present()[0].centre, Vec3(5, 0, 0));
}

TEST(LooseRocks, FallWhenTheVehicleComesNear) {
  cave::LooseRock b = rock_at({5, 0, 0});
  b.within_m = 2;
  LooseRocks boulders({b});
  EXPECT_FALSE(boulders.advance(1, Vec3(2.9, 0, 0)));
  EXPECT_TRUE(boulders.advance(2, Vec3(3.1, 0, 0)));
  EXPECT_FALSE(boulders.advance(3, Vec3(-9, 0, 0)));
  EXPECT_EQ(boulders.present().size(), 1u);
}

TEST(LooseRocks, GoToAndFro) {
  cave::LooseRock b = rock_at({0, 0, 0});
  b.to = {4, 0, 0};
  b.speed_mps = 1;
  LooseRocks boulders({b});
  const auto x = [&](double t_s) {
    EXPECT_TRUE(boulders.advance(t_s, Vec3::Zero()));
    return boulders.present().at(0).centre.x();
  };
  EXPECT_NEAR(x(0), 0, 1e-12);
  EXPECT_NEAR(x(3), 3, 1e-12);
  EXPECT_NEAR(x(5), 3, 1e-12);
  EXPECT_NEAR(x(8.5), 0.5, 1e-12);
}

/// A finely triangulated ball is the oracle of the closed form.
cave::TriangleMesh ball_mesh(const Vec3& c, double r) {
  constexpr int n = 120;
  cave::TriangleMesh m;
  const auto at = [&](int i, int j) {
    const double theta = std::numbers::pi * i / n, phi = 2 * std::numbers::pi * j / n;
    return Vec3(c +
                r * Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) add_quad(m, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return m;
}

RC_GTEST_PROP(LooseRocks, AreMetByRaysAndNearestPointsAsTheirMeshWouldBe, ()) {
  const auto number = [](double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 10000) / 10000.0;
  };
  const Vec3 centre(1, 2, 0.5);
  const double radius = 1.5;
  static const cave::RayScene mesh(ball_mesh(centre, radius));
  static const cave::RayScene ball =
      cave::RayScene(box_mesh({-50, -50, -50}, {50, 50, 50})).with_boulders({{centre, radius}});
  const Vec3 from(number(-4, 6), number(-3, 7), number(-4, 5));
  const Vec3 towards = Vec3(number(-1, 3), number(0, 4), number(-1.5, 2.5)) - from;
  RC_PRE(towards.norm() > 0.1 && std::abs((from - centre).norm() - radius) > 0.02);
  const double range = ball.ray_cast(from, towards, 20), expected = mesh.ray_cast(from, towards, 20);
  // Rays that graze may miss the inscribed mesh.
  const double passes_m = (centre - from).cross(towards.normalized()).norm();
  if (passes_m < radius - 0.02) {
    RC_ASSERT(std::abs(range - expected) < 0.02 || (std::isinf(range) && std::isinf(expected)));
  }
  RC_ASSERT(std::abs(ball.nearest(from, 20).distance_m - mesh.nearest(from, 20).distance_m) < 0.003);
}

TEST(LooseRocks, ASceneWithoutThemIsAsBefore) {
  const cave::RayScene box(box_mesh({-5, -5, -5}, {5, 5, 5}));
  const cave::RayScene blocked = box.with_boulders({{{2, 0, 0}, 1}});
  EXPECT_NEAR(blocked.ray_cast({0, 0, 0}, {1, 0, 0}, 20), 1, 1e-6);
  EXPECT_NEAR(box.ray_cast({0, 0, 0}, {1, 0, 0}, 20), 5, 1e-6);
  EXPECT_NEAR(blocked.with_boulders({}).ray_cast({0, 0, 0}, {1, 0, 0}, 20), 5, 1e-6);
}

}  // namespace
}  // namespace karst::test
