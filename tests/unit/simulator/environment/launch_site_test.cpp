#include "plugins/simulator/environment/launch_site.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

TEST(LaunchSite, TheVehicleStandsOnTheFloorBelowTheStartPose) {
  cave::Cave c = make_cave(box_mesh({-5, -5, 0}, {5, 5, 4}), {1, 2, 1.5}, 0.6);
  const sim::LaunchSite site = sim::set_down(c, 0.3);
  EXPECT_FALSE(site.pad);
  EXPECT_LT((site.T_world_start.position - Vec3(1, 2, 0.3)).norm(), 2e-4);
  EXPECT_NEAR(core::heading_of(site.T_world_start.orientation), 0.6, 1e-12);
}

TEST(LaunchSite, AboveADeepFloorItStandsOnAPadThatSensorsSee) {
  cave::Cave c = make_cave(box_mesh({-5, -5, -9}, {5, 5, 4}), {1, 2, 1.5});
  const sim::LaunchSite site = sim::set_down(c, 0.3);
  EXPECT_TRUE(site.pad);
  EXPECT_EQ(site.T_world_start.position, Vec3(1, 2, 1.5));
  EXPECT_NEAR(c.scene.ray_cast({1.2, 2.1, 1.5}, {0, 0, -1}, 50), 0.3, 1e-5);
  EXPECT_NEAR(c.scene.ray_cast({1.6, 2.1, 1.5}, {0, 0, -1}, 50), 10.5, 1e-5);
}

TEST(LaunchSite, OnASlopeTooSteepItStandsOnAPad) {
  for (const double degrees : {40.0, 60.0}) {
    auto mesh = box_mesh({-9, -9, -20}, {9, 9, 20});
    const double rise = std::tan(degrees * std::numbers::pi / 180);
    add_quad(mesh, {-8, -8, -8 * rise}, {8, -8, 8 * rise}, {8, 8, 8 * rise}, {-8, 8, -8 * rise});
    cave::Cave c = make_cave(mesh, {0, 0, 2});
    EXPECT_EQ(sim::set_down(c, 0.3).pad, degrees > 50) << degrees;
  }
}

}  // namespace
}  // namespace karst::test
