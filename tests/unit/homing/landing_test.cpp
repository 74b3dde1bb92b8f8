#include "core_stack/homing/landing_place.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/SVD>
#include <numbers>

#include "core_stack/common/random.h"
#include "plugins/simulator/cave_generator/generate_cave.h"
#include "tests/benchmark/cave_map.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

constexpr double kRadius = 0.3;

/// Rock below `floor(x, y)` in cells, free above it, up to cell 15.
VoxelMap floor_map(const std::function<int(int x, int y)>& floor) {
  VoxelMap map{MapOptions{}};
  for (int x = -12; x < 12; ++x)
    for (int y = -12; y < 12; ++y)
      for (int z = -3; z < 16; ++z) map.assign({x, y, z}, 1, z < floor(x, y) ? 2.0f : -2.0f);
  return map;
}
const Vec3 kPlace(0.1, 0.1, 1.5);

GroundVerdict verdict(const VoxelMap& map) { return ground_below(map, kPlace, kRadius, {}).verdict; }

TEST(Ground, FlatIsGoodAndLiesWhereTheFloorIs) {
  const Ground g = ground_below(floor_map([](int, int) { return 2; }), kPlace, kRadius, {});
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
    const Ground g = ground_below(map, place, kRadius, options);

    std::vector<Vec3> points;
    bool open_to_floor = true;
    for (int x = -12; x < 12; ++x)
      for (int y = -12; y < 12; ++y) {
        const Vec3 c = map.center_of({x, y, 0});
        if (std::hypot(c.x() - place.x(), c.y() - place.y()) > kRadius + options.margin_m) continue;
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
    RC_PRE(std::abs(slope - limit) > 1e-6 && std::abs(step - options.most_step_m) > 1e-6);
    const bool expected = open_to_floor && slope < limit && step < options.most_step_m;
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

/// A passage along x with a floor at z = 0, free inside.
VoxelMap passage(double width_m, double height_m, double length_m = 20,
                 std::vector<CellChange>* changes = nullptr) {
  VoxelMap map{MapOptions{}};
  const int w = static_cast<int>(std::lround(width_m / 0.4)),
            h = static_cast<int>(std::lround(height_m / 0.2)),
            l = static_cast<int>(std::lround(length_m / 0.4));
  testing::draw(
      map, {-l - 2, -w - 2, -2}, {l + 2, w + 2, h + 2},
      [&](const CellKey& k) {
        return std::abs(k.x) < l && k.y >= -w && k.y < w && k.z >= 0 && k.z < h ? Cell::free : Cell::occupied;
      },
      changes);
  return map;
}

TEST(OthersGetBy, OverItBesideItOrNotAtAll) {
  const Vec3 middle(0.1, 0.1, 0.3);
  EXPECT_TRUE(others_get_by(passage(2, 3.2), middle, kRadius, 0.55, 3));     // over it
  EXPECT_FALSE(others_get_by(passage(1.6, 1.4), middle, kRadius, 0.55, 3));  // neither over nor past it
  EXPECT_TRUE(others_get_by(passage(6, 1.6), middle, kRadius, 0.55, 3));     // past it
  EXPECT_TRUE(others_get_by(passage(3.2, 1.6), {0.1, -1.1, 0.3}, kRadius, 0.55, 3));  // on one side of it
  // At the end of a blind passage nobody is held up.
  EXPECT_TRUE(others_get_by(passage(2, 1.6), {9, 0.1, 0.3}, kRadius, 0.55, 3));
}

// A relay landed where others got by by its radius; in their maps it filled cells, and closed the passage.
TEST(OthersGetBy, StillWhenTheyHaveMappedIt) {
  const PlanningOptions planning;
  Random random = Random::stream(5, "landed");
  int allowed = 0, closed_without = 0;
  for (int n = 0; n < 200; ++n) {
    std::vector<CellChange> changes;
    VoxelMap map = passage(random.uniform(2, 4), random.uniform(1.3, 1.9), 8, &changes);
    const Vec3 standing(random.uniform(-0.5, 0.5), random.uniform(-1, 1), kRadius);
    const double clearance_m = search_clearance_m(planning, map.resolution_m());
    const bool by_radius = others_get_by(map, standing, kRadius, clearance_m, 3),
               as_mapped = others_get_by(map, standing, kRadius + kAsMapped_m, clearance_m, 3);
    const Vec3 landed = standing + 0.1 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 p = landed + kRadius * Vec3(random.normal(), random.normal(), random.normal()).normalized();
      map.assign(map.key_of(p), 1, 2.0f);
    }
    Roadmap roadmap(planning);
    roadmap.update(map, changes);
    const bool open =
        std::isfinite(roadmap.distances(map, {-3, 0.1, 0.8}, std::vector{Vec3(3, 0.1, 0.8)}, 0.6).front());
    if (as_mapped) EXPECT_TRUE(open) << n;
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
  EXPECT_TRUE(others_get_by(map, {0.1, 1.5, 0.3}, kRadius, 0.55, 3));
}

TEST(LinkEstimate, UnknownAndRockTakeTheirDecibels) {
  const VoxelMap map = passage(2, 2, 20);
  const LinkEstimateOptions o;
  EXPECT_EQ(not_free_m(map, {-9, 0, 1}, {9, 0, 1}), 0);
  EXPECT_NEAR(not_free_m(map, {0, 0, 1}, {0, 5, 1}), 4, 0.03);
  EXPECT_NEAR(expected_margin_db(map, {0, 0, 1}, {5, 0, 1}, o), 20 - 6, 1e-9);
  EXPECT_NEAR(expected_margin_db(map, {0, 0, 1}, {0, 5, 1}, o), 20 - 6 - 3 * 4, 0.1);
  LinkEstimateOptions distance = o;
  distance.rock_db_per_m = 0, distance.spare_db = 0;
  EXPECT_GT(expected_margin_db(map, {0, 0, 1}, {0, 49.9, 1}, distance), 0);
  EXPECT_LT(expected_margin_db(map, {0, 0, 1}, {0, 50.1, 1}, distance), 0);
}

struct Landing : ::testing::Test {
  std::vector<CellChange> changes;
  VoxelMap map = passage(4, 3.2, 60, &changes);
  PlanningOptions planning;
  Roadmap roadmap{planning};
  LandingOptions options;
  LandingRequest request;
  void SetUp() override {
    roadmap.update(map, changes);
    request.from = {25, 0.1, 1};
    for (double x = -25; x <= 25; x += 4) request.around.push_back({x, 0.1, 1});
    request.nodes = {{-28, 0.1, 0.3}};
  }
  LandingSearch find() const { return find_landing_places(map, roadmap, request, options, planning, {}); }
  std::size_t refused(const LandingSearch& s, LandingRefusal r) const {
    return s.refused[static_cast<std::size_t>(r)];
  }
};

TEST_F(Landing, AsFarFromTheNodeAsTheRadioCarriesAndAllOfItHolds) {
  options.second_m = 0;
  const LandingSearch s = find();
  ASSERT_EQ(s.places.size(), 4u);
  // 50 m less 6 dB to spare: 25 m.
  EXPECT_NEAR(s.places[0].extension_m, 25.06, 0.8);
  for (const LandingPlace& p : s.places) {
    EXPECT_EQ(ground_below(map, p.hover, kRadius, options.ground).verdict, GroundVerdict::good);
    EXPECT_GE(p.margin_db, 0);
    EXPECT_EQ(p.links, 1u);
    EXPECT_NEAR(p.ground.z(), 0, 1e-9);
    EXPECT_LT((p.hover - p.ground).head<2>().norm(), 1e-9);
    EXPECT_TRUE(roadmap.find(map, request.from, p.hover).found());
    EXPECT_LE(p.score, s.places[0].score);
  }
  EXPECT_GT(refused(s, LandingRefusal::out_of_reach), 0u);
  EXPECT_GT(refused(s, LandingRefusal::no_extension), 0u);
}

TEST_F(Landing, KeepsApartFromOthersInTimeAndPrefersASecondLink) {
  const LandingPlace best = find().places.at(0);
  request.others = {best.ground};
  for (const LandingPlace& p : find().places)
    EXPECT_GE((p.ground - best.ground).norm(), options.keep_apart_m);
  request.others.clear();
  request.most_time_s = best.time_s / 2;
  const LandingSearch hurried = find();
  EXPECT_TRUE(hurried.places.empty());
  EXPECT_GT(refused(hurried, LandingRefusal::no_time), 0u);
  request.most_time_s = 1e9;
  options.second_m = 0, options.second_link_m = 0;
  EXPECT_EQ(find().places.at(0).links, 1u);
  // Another node 10 m farther on: where both are heard is worth more than the farthest place.
  request.nodes.push_back({-18, 0.1, 0.3});
  options.second_link_m = 30;
  EXPECT_EQ(find().places.at(0).links, 2u);
}

TEST_F(Landing, WithoutANodeOrAWayThereIsNoPlaceAndAReason) {
  request.nodes.clear();
  EXPECT_TRUE(find().places.empty());
  EXPECT_GT(refused(find(), LandingRefusal::out_of_reach), 0u);
  request.nodes = {{-28, 0.1, 0.3}};
  std::vector<CellChange> fall;
  for (int y = -10; y < 10; ++y)
    for (int z = 0; z < 16; ++z) {
      map.assign({50, y, z}, 1, 2.0f);
      fall.push_back({{50, y, z}, Cell::free, Cell::occupied});
    }
  roadmap.update(map, fall);
  EXPECT_TRUE(find().places.empty());
  EXPECT_GT(refused(find(), LandingRefusal::no_way), 0u);
  for (std::size_t r = 0; r < kLandingRefusals; ++r)
    EXPECT_NE(landing_refusal_text(static_cast<LandingRefusal>(r)), nullptr);
}

TEST(LandingInACave, EveryPlaceIsOnTheRockItselfClearOfItAndReachable) {
  cave::CaveRecipe recipe = cave::cave_preset("small");
  recipe.volume_m3 = 900, recipe.grid_m = 0.4;
  const cave::GeneratedCave made = cave::generate_cave(recipe, 4);
  const cave::RayScene scene(made.mesh);
  bench::CaveMap drawn = bench::map_of_cave(made.mesh, made.start.position);
  const PlanningOptions planning;
  Roadmap roadmap{planning};
  roadmap.update(drawn.map, testing::all_cells(drawn.map));

  LandingRequest request;
  request.from = made.start.position;
  for (const auto& way : made.ways)
    for (std::size_t i = 0; i < way.size(); i += 8) request.around.push_back(way[i]);
  request.nodes = {made.start.position};
  LandingOptions options;
  options.most_places = 20;
  const LandingSearch s = find_landing_places(drawn.map, roadmap, request, options, planning, {});
  EXPECT_GT(s.candidates, 100u);
  ASSERT_GE(s.places.size(), 4u);
  for (const LandingPlace& p : s.places) {
    // The map's floor is the top of a cell that holds rock: the rock is at most a cell lower.
    const double down_m = scene.ray_cast(p.hover, -Vec3::UnitZ(), 10);
    EXPECT_NEAR(down_m, (p.hover - p.ground).z(), 0.25);
    // On the way down the vehicle's sphere touches nothing, until it comes to what the floor's roughness may
    // be.
    for (double z = p.ground.z() + kRadius + 0.3; z < p.hover.z(); z += 0.1)
      EXPECT_GE(scene.distance_to_rock({p.hover.x(), p.hover.y(), z}, 1), kRadius) << p.hover.transpose();
    EXPECT_TRUE(roadmap.find(drawn.map, request.from, p.hover).found());
    EXPECT_GE(expected_margin_db(drawn.map, p.ground + Vec3(0, 0, kRadius), request.nodes[0], options.link),
              0);
  }
}

}  // namespace
}  // namespace karst::core
