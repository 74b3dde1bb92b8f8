#include "core_stack/homing/landing/landing_ground.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/SVD>
#include <numbers>

#include "core_stack/common/random.h"
#include "core_stack/homing/landing/link_estimate.h"
#include "core_stack/planning/search/grid_planner.h"
#include "tests/unit/homing/passage.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using testing::passage;

constexpr double kRobotRadius_m = 0.3;

/// Rock below `floor(x, y)` in cells, free above it, up to cell 15.
VoxelMap floor_map(const std::function<int(int x, int y)>& floor) {
  VoxelMap map{MapOptions{}};
  for (int x = -12; x < 12; ++x)
    for (int y = -12; y < 12; ++y)
      for (int z = -3; z < 16; ++z) map.assign({x, y, z}, 1, z < floor(x, y) ? 2.0f : -2.0f);
  return map;
}
const Vec3 kPlace(0.1, 0.1, 1.5);

GroundVerdict verdict(const VoxelMap& map) { return ground_below(map, kPlace, kRobotRadius_m, {}).verdict; }

TEST(Ground, FlatIsGoodAndLiesWhereTheFloorIs) {
  const Ground g = ground_below(floor_map([](int, int) { return 2; }), kPlace, kRobotRadius_m, {});
  EXPECT_EQ(g.verdict, GroundVerdict::good);
  EXPECT_NEAR((g.ground - Vec3(0.1, 0.1, 0.4)).norm(), 0, 1e-9);
  EXPECT_NEAR(g.step_m, 0, 1e-9);
  EXPECT_NEAR(g.slope_rad, 0, 1e-9);
}

TEST(Ground, SteepRoughObstructedUnknownAndBottomlessAreRefused) {
  EXPECT_EQ(verdict(floor_map([](int x, int) { return 2 + (x >> 1); })), GroundVerdict::steep);
  EXPECT_EQ(verdict(floor_map([](int x, int) { return x == 0 ? 4 : 2; })), GroundVerdict::rough);
  EXPECT_EQ(verdict(floor_map([](int x, int y) { return x == 2 && y == 0 ? 12 : 2; })),
            GroundVerdict::obstructed);
  EXPECT_EQ(verdict(floor_map([](int, int) { return -3; })), GroundVerdict::no_floor);
  EXPECT_EQ(verdict(floor_map([](int x, int) { return x < 2 ? 2 : -3; })), GroundVerdict::rough);  // an edge
  VoxelMap map{MapOptions{}};
  EXPECT_EQ(verdict(map), GroundVerdict::no_floor);  // the place itself is not known
  for (int x = -5; x < 5; ++x)
    for (int y = -5; y < 5; ++y)
      for (int z = 3; z < 12; ++z) map.assign({x, y, z}, 1, -2.0f);
  EXPECT_EQ(verdict(map), GroundVerdict::unknown);  // air, and nothing seen of the floor below
}

/// All columns cell by cell, the plane by singular values: another way to the same answer.
TEST(Ground, AgreesWithBruteForceOnRandomFloors) {
  int good = 0, bad = 0;
  rc::check("floors", [&] {
    Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
    const double tilt_x = random.uniform(-0.4, 0.4), tilt_y = random.uniform(-0.4, 0.4);
    const double rough = random.uniform(0, 0.5);
    VoxelMap map = floor_map([&](int x, int y) {
      return 2 + static_cast<int>(std::lround(tilt_x * x + tilt_y * y)) + (random.uniform() < 0.1 * rough);
    });
    for (int i = 0; i < 3; ++i) {
      const CellKey k{static_cast<int>(random.bits() % 12) - 6, static_cast<int>(random.bits() % 12) - 6,
                      static_cast<int>(random.bits() % 7)};
      if (random.uniform() < 0.2) map.assign(k, 1, 2.0f);
    }
    const GroundOptions options;
    const Vec3 place(random.uniform(-1, 1), random.uniform(-1, 1), 1.5);
    const Ground g = ground_below(map, place, kRobotRadius_m, options);

    std::vector<Vec3> points;
    bool open_to_floor = true;
    for (int x = -12; x < 12; ++x)
      for (int y = -12; y < 12; ++y) {
        const Vec3 c = map.center_of({x, y, 0});
        if (std::hypot(c.x() - place.x(), c.y() - place.y()) > kRobotRadius_m + options.margin_m) continue;
        int top = 100;
        for (int z = -3; z <= 7; ++z)
          if (map.at(CellKey{x, y, z}) == Cell::occupied) top = z;
        open_to_floor &= top < 7;
        points.push_back({c.x(), c.y(), 0.2 * (top + 1)});
      }
    Eigen::MatrixXd a(points.size(), 3);
    Eigen::VectorXd z(points.size());
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      a.row(i) << points[i].x(), points[i].y(), 1;
      z[i] = points[i].z();
    }
    const Eigen::Vector3d plane = a.jacobiSvd(Eigen::ComputeThinU | Eigen::ComputeThinV).solve(z);
    const Eigen::VectorXd above = z - a * plane;
    const double step = above.maxCoeff() - above.minCoeff();
    const double slope = std::atan(plane.head<2>().norm()), limit = 15 * std::numbers::pi / 180;
    RC_PRE(std::abs(slope - limit) > 1e-6 && std::abs(step - options.max_step_m) > 1e-6);
    const bool expected = open_to_floor && slope < limit && step < options.max_step_m;
    RC_ASSERT((g.verdict == GroundVerdict::good) == expected);
    if (expected) {
      RC_ASSERT(std::abs(g.slope_rad - slope) < 1e-6);
      RC_ASSERT(std::abs(g.step_m - step) < 1e-6);
    }
    ++(expected ? good : bad);
  });
  EXPECT_GT(good, 10);
  EXPECT_GT(bad, 10);
}

TEST(OthersGetBy, OverItBesideItOrNotAtAll) {
  const Vec3 middle(0.1, 0.1, 0.3);
  EXPECT_TRUE(keeps_passage_open(passage(2, 3.2), middle, kRobotRadius_m, 0.55, 3));  // over it
  EXPECT_FALSE(
      keeps_passage_open(passage(1.6, 1.4), middle, kRobotRadius_m, 0.55, 3));  // neither over nor past it
  EXPECT_TRUE(keeps_passage_open(passage(6, 1.6), middle, kRobotRadius_m, 0.55, 3));  // past it
  EXPECT_TRUE(
      keeps_passage_open(passage(3.2, 1.6), {0.1, -1.1, 0.3}, kRobotRadius_m, 0.55, 3));  // on one side of it
  // At the end of a blind passage nobody is held up.
  EXPECT_TRUE(keeps_passage_open(passage(2, 1.6), {9, 0.1, 0.3}, kRobotRadius_m, 0.55, 3));
}

// A relay landed where others got by by its radius; in their maps it filled cells, and closed the passage.
TEST(OthersGetBy, StillWhenTheyHaveMappedIt) {
  const PlanningOptions planning;
  Random random = Random::stream(5, "landed");
  int allowed = 0, closed_without = 0;
  for (int n = 0; n < 200; ++n) {
    const double width_m = random.uniform(2, 4), height_m = random.uniform(1.3, 1.9);
    VoxelMap map = passage(width_m, height_m, 12);  // open beyond the cube that is looked at
    const auto within = [&](double half) { return random.uniform(-half, half); };
    const Vec3 standing{within(0.5), within(1), kRobotRadius_m};  // in braces: drawn from left to right
    const double clearance_m = search_clearance_m(planning, map.resolution_m());
    const bool by_radius = keeps_passage_open(map, standing, kRobotRadius_m, clearance_m, 3),
               as_mapped = keeps_passage_open(map, standing, kRobotRadius_m + kAsMapped_m, clearance_m, 3);
    const Vec3 landed = standing + Vec3{within(0.1), within(0.1), 0};
    for (int i = 0; i < 1000; ++i) {
      const Vec3 towards{random.normal(), random.normal(), random.normal()};
      const Vec3 p = landed + kRobotRadius_m * towards.normalized();
      map.assign(map.key_of(p), 1, 2.0f);
    }
    const bool open = plan_on_grid_squeezing(map, {-3, 0.1, 0.8}, {3, 0.1, 0.8}, planning).found();
    EXPECT_TRUE(open || !as_mapped) << n;
    allowed += as_mapped;
    closed_without += by_radius && !open;
  }
  EXPECT_GT(allowed, 10);
  EXPECT_GT(closed_without, 0) << "or the margin does nothing";
}

TEST(OthersGetBy, AWallBesideThatWasClosedBeforeIsNoMatter) {
  // Two passages side by side, not joined: landing in one leaves the other what it was.
  VoxelMap map = passage(6, 3.2);
  for (int x = -60; x < 60; ++x)
    for (int z = 0; z < 16; ++z) map.assign({x, 0, z}, 1, 2.0f);
  EXPECT_TRUE(keeps_passage_open(map, {0.1, 1.5, 0.3}, kRobotRadius_m, 0.55, 3));
}

TEST(LinkEstimate, UnknownAndRockTakeTheirDecibels) {
  const VoxelMap map = passage(2, 2, 20);
  LinkEstimateOptions o;
  o.spare_db = 6;
  EXPECT_EQ(not_free_m(map, {-9, 0, 1}, {9, 0, 1}), 0);
  EXPECT_NEAR(not_free_m(map, {0, 0, 1}, {0, 5, 1}), 4, 0.03);
  EXPECT_NEAR(expected_margin_db(map, {0, 0, 1}, {5, 0, 1}, o), 20 - 6, 1e-9);
  EXPECT_NEAR(expected_margin_db(map, {0, 0, 1}, {0, 5, 1}, o), 20 - 6 - 3 * 4, 0.1);
  LinkEstimateOptions distance = o;
  distance.rock_db_per_m = 0, distance.spare_db = 0;
  EXPECT_GT(expected_margin_db(map, {0, 0, 1}, {0, 49.9, 1}, distance), 0);
  EXPECT_LT(expected_margin_db(map, {0, 0, 1}, {0, 50.1, 1}, distance), 0);
}

}  // namespace
}  // namespace karst::core
