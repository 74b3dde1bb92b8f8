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

/// What a scan shows of a ball, in a map of the wall alone.
std::vector<Vec3> found(const Vec3f& ball) {
  VoxelMap map{MapOptions{}};
  for (int i = 0; i < 20; ++i) map.insert(seen({50, 50, 50}));
  return bodies_in_the_air(map, seen(ball));
}

TEST(BodiesInTheAir, AreWhereAScanHitsWhatWasFree) {
  const std::vector<Vec3> bodies = found({5, 0.4f, 0.2f});
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_LT((bodies[0] - Vec3(5, 0.4, 0.2)).norm(), 0.35) << "of a ball of 0.3 m the near side is seen";
}

TEST(BodiesInTheAir, AreFoundNearRock) {
  EXPECT_EQ(found({kWall_m - 1.2f, 0, 0}).size(), 1u);
  EXPECT_EQ(found({kWall_m - 0.6f, 0, 0}).size(), 1u);
}

TEST(BodiesInTheAir, AWallThatAWrongPoseMovesIntoTheOpenIsNone) {
  VoxelMap map{MapOptions{}};
  for (int i = 0; i < 20; ++i) map.insert(seen({50, 50, 50}));
  for (const float nearer_m : {0.2f, 0.5f, 1.0f}) {
    std::vector<Ray> moved = seen({50, 50, 50});
    for (Ray& r : moved) r.end.x() -= nearer_m;
    EXPECT_TRUE(bodies_in_the_air(map, moved).empty()) << nearer_m;
  }
}

TEST(BodiesInTheAir, AreFoundInWhatTheyWereTakenForBefore) {
  VoxelMap map{MapOptions{}};
  for (int i = 0; i < 20; ++i) map.insert(seen({50, 50, 50}));
  for (int i = 0; i < 4; ++i) map.insert(seen({5, 0, 0}));
  ASSERT_EQ(map.at(Vec3(4.7, 0, 0)), Cell::occupied);
  EXPECT_TRUE(bodies_in_the_air(map, seen({5, 0, 0})).empty()) << "it stands, and is an obstacle";
  EXPECT_EQ(bodies_in_the_air(map, seen({4.6f, 0.3f, 0})).size(), 1u);
}

// As it was: one that came straight at the sensor hid what it left occupied behind it, and counted as rock.
TEST(BodiesInTheAir, AreFoundBeforeTheLongTrailThatTheyHide) {
  VoxelMap map{MapOptions{}};
  for (int i = 0; i < 20; ++i) map.insert(seen({50, 50, 50}));
  float x = 9.0f;
  for (; x > 5; x -= 0.1f) map.insert(seen({x, 0, 0}));
  int times_found = 0;
  for (; x > 4; x -= 0.1f) {
    times_found += static_cast<int>(bodies_in_the_air(map, seen({x, 0, 0})).size());
    map.insert(seen({x, 0, 0}));
  }
  EXPECT_GE(times_found, 5) << "of ten scans";
}

/// Rays of a scan in another direction.
std::vector<Ray> turned(std::vector<Ray> rays, float by_rad) {
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(by_rad, Vec3f::UnitZ()).toRotationMatrix();
  for (Ray& r : rays) {
    r.origin = turn * r.origin;
    r.end = turn * r.end;
  }
  return rays;
}

// As it was: what hides behind a body was looked for behind its cell of the lowest key, which may be its rim.
TEST(BodiesInTheAir, AreFoundWhicheverWayTheyComeFrom) {
  for (const float heading_rad : {0.0f, 0.7f, 1.57f, 2.5f, 3.14f, -0.8f, -1.57f}) {
    VoxelMap map{MapOptions{}};
    const auto scan = [&](float x) { return turned(seen({x, 0, 0}), heading_rad); };
    for (int i = 0; i < 20; ++i) map.insert(scan(-50));
    float x = 9.5f;
    for (; x > 5; x -= 0.1f) map.insert(scan(x));
    int times_found = 0;
    for (; x > 4; x -= 0.1f) {
      times_found += static_cast<int>(bodies_in_the_air(map, scan(x)).size());
      map.insert(scan(x));
    }
    EXPECT_GE(times_found, 4) << "of ten scans, heading " << heading_rad;
  }
}

TEST(BodiesInTheAir, AScanFullOfDustIsNotSearched) {
  VoxelMap map{MapOptions{}};
  for (int i = 0; i < 20; ++i) map.insert(seen({50, 50, 50}));
  std::vector<Ray> dust;
  for (int i = 0; i < 20; ++i)
    for (const Ray& r : seen({50, 50, 50})) {
      const auto somewhere = static_cast<float>(dust.size() * 7919 % 1000) / 1000;
      dust.push_back({r.origin, r.end * (0.05f + 0.9f * somewhere), true});
    }
  EXPECT_TRUE(bodies_in_the_air(map, dust).empty());
}

TEST(BodiesInTheAir, NoiseAtTheWallIsNone) {
  VoxelMap map{MapOptions{}};
  for (int i = 0; i < 20; ++i) map.insert(seen({50, 50, 50}));
  std::vector<Ray> noisy = seen({50, 50, 50});
  for (std::size_t i = 0; i < noisy.size(); ++i)
    noisy[i].end *= 1 + 0.01f * static_cast<float>(static_cast<int>(i * 7 % 5) - 2);
  EXPECT_TRUE(bodies_in_the_air(map, noisy).empty());
  EXPECT_TRUE(bodies_in_the_air(VoxelMap{MapOptions{}}, seen({5, 0, 0})).empty()) << "nothing was free";
}

}  // namespace
}  // namespace karst::core
