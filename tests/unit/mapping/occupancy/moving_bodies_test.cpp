// What the map makes of another vehicle that flies through it.
#include "core_stack/mapping/occupancy/moving_bodies.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {
namespace {

constexpr float kWall_m = 10.1f;

/// Rays from the origin to a wall at x = 10.1 m, in front of which a ball of 0.3 m hovers.
std::vector<Ray> seen(const Vec3f& ball) {
  std::vector<Ray> rays;
  for (int i = -40; i <= 40; ++i)
    for (int k = -20; k <= 20; ++k) {
      const Vec3f end(kWall_m, 0.05f * static_cast<float>(i), 0.05f * static_cast<float>(k));
      const Vec3f d = end.normalized();
      const float along = ball.dot(d), beside2 = ball.squaredNorm() - along * along;
      const bool hits_ball = beside2 < 0.09f;
      rays.push_back(
          {Vec3f::Zero(), hits_ball ? Vec3f((along - std::sqrt(0.09f - beside2)) * d) : end, true});
    }
  return rays;
}

int occupied_before_wall(const VoxelMap& map) {
  int n = 0;
  map.for_each_known([&](const CellKey& k, Cell c, float) {
    n += c == Cell::occupied && map.center_of(k).x() < kWall_m - 0.5;
  });
  return n;
}

TEST(MovingBodies, LeaveNoGhostWhereTheyPass) {
  VoxelMap with(MapOptions{}), without(MapOptions{});
  for (int step = 0; step < 20; ++step) {
    const Vec3 at(5, -2 + 0.1 * step, 0);
    std::vector<Ray> rays = seen(at.cast<float>());
    without.insert(rays);
    // It told a place half a metre off.
    leave_out(rays, std::vector<MovingBody>{{at + Vec3(0.3, -0.4, 0), 0.9}});
    with.insert(rays);
  }
  EXPECT_GT(occupied_before_wall(without), 0);
  EXPECT_EQ(occupied_before_wall(with), 0);
  EXPECT_EQ(with.at(Vec3(4.0, 0.0, 0.0)), Cell::free) << "the way up to it is seen";
  EXPECT_EQ(with.at(Vec3(kWall_m, 1.0, 0.5)), Cell::occupied) << "rock beside it stays";
}

TEST(MovingBodies, AGhostFromBeforeTheContactGoesWithinTwoSecondsOfScans) {
  VoxelMap map{MapOptions{}};
  const Vec3f ball(5, 0, 0);
  for (int i = 0; i < 50; ++i) map.insert(seen(ball));
  ASSERT_GT(occupied_before_wall(map), 0);
  for (int i = 0; i < 20; ++i) map.insert(seen({50, 50, 50}));  // it is away
  EXPECT_EQ(occupied_before_wall(map), 0);
}

TEST(MovingBodies, ThatAreNotThereChangeNothing) {
  std::vector<Ray> rays = seen({5, 0, 0});
  const std::vector<Ray> before = rays;
  leave_out(rays, {});
  leave_out(rays, std::vector<MovingBody>{{{5, 20, 0}, 1.0}});
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(rays[i].hit, before[i].hit);
}

}  // namespace
}  // namespace karst::core
