#include "plugins/simulator/dynamics/contact.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using sim::ContactWatch;
using sim::Touch;

TEST(Contact, TheSphereTouchesAPlaneAtItsRadius) {
  const cave::RayScene scene(box_mesh({-9, -9, 0}, {9, 9, 9}));
  ContactWatch watch(scene, 0.3);
  EXPECT_FALSE(watch.touch({1, 2, 0.301}));
  const auto touch = watch.touch({1, 2, 0.29});
  ASSERT_TRUE(touch);
  EXPECT_LT((touch->direction + Vec3::UnitZ()).norm(), 1e-6);
  EXPECT_LT((touch->place - Vec3(1, 2, 0)).norm(), 1e-6);
  EXPECT_NEAR(touch->depth_m, 0.01, 1e-6);
  EXPECT_NEAR(watch.clearance_m({1, 2, 2}), 1.7, 1e-6);
}

TEST(Contact, NoTouchIsMissedByAskingLessOften) {
  const auto mesh = tunnel_mesh(30, 2.5, 8);
  const cave::RayScene scene(mesh);
  core::Random r(6);
  long asked = 0, steps = 0;
  for (int flight = 0; flight < 40; ++flight) {
    ContactWatch watch(scene, 0.3);
    Vec3 p(r.uniform(2, 28), 0, 0);
    const Vec3 step = random_unit(r) * r.uniform(0.0005, 0.02);
    for (int i = 0; i < 4000; ++i, ++steps) {
      const bool touching = scene.distance_to_rock(p, 50) <= 0.3;
      ASSERT_EQ(watch.touch(p).has_value(), touching);
      if (touching) break;
      p += step;
    }
    asked += watch.queries();
  }
  EXPECT_LT(asked, steps / 5) << "most steps need no query";
}

TEST(Contact, GroundSupportsWithin50DegreesAndBelow80CentimetresASecond) {
  const auto leaning = [](double deg) {
    const double a = deg * std::numbers::pi / 180;
    return Touch{Vec3::Zero(), {std::sin(a), 0, -std::cos(a)}, 0};
  };
  EXPECT_TRUE(sim::supports(leaning(0), {0, 0, -0.5}));
  EXPECT_TRUE(sim::supports(leaning(49), {0, 0, -0.5}));
  EXPECT_FALSE(sim::supports(leaning(51), {0, 0, -0.5}));
  EXPECT_FALSE(sim::supports(leaning(180), {0, 0, 0.1}));
  EXPECT_FALSE(sim::supports(leaning(0), {0, 0, -0.81}));
  EXPECT_NEAR(sim::angle_from_down_rad(leaning(90)), std::numbers::pi / 2, 1e-12);
}

}  // namespace
}  // namespace karst::test
