#include "core_stack/team/relay_homing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "core_stack/homing/path_home/home.h"
#include "plugins/simulator/cave_generator/generate_cave.h"
#include "tests/benchmark/cave_map.h"
#include "tests/unit/homing/passage.h"

namespace karst::core {
namespace {

constexpr double kRadius = 0.3, kAlways = std::numeric_limits<double>::infinity();

TeamOptions team_with(LandingStrategy strategy) {
  TeamOptions team;
  team.strategy = strategy;
  return team;
}

/// Only the base is heard; the battery ends after ten minutes.
TeamNews hearing(const Vec3& base) {
  TeamNews news;
  news.relays = {{kBase, base, base}};
  news.ends = 600 * kSecond;
  return news;
}

/// A robot that has flown 53 m of a straight passage, away from the base at its beginning.
struct Flown : ::testing::Test {
  std::vector<CellChange> changes;
  VoxelMap map = testing::passage(4, 3.2, 60, &changes);
  PlanningOptions planning;
  MotionLimits limits;
  Roadmap roadmap{planning};
  HomingOptions options;
  const Vec3 base{-28, 0.1, 1}, far{25, 0.1, 1};
  TeamNews news = hearing(base);

  Flown() { roadmap.update(map, changes), options.landing.link.spare_db = 6; }
  RelayHoming homing(LandingStrategy strategy) const {
    return {1, {team_with(strategy), options, planning, limits, kRadius, base}};
  }
  void fly(RelayHoming& homing, double from_x, double to_x) {
    for (double x = from_x; x <= to_x; x += 1) homing.update(map, roadmap, {x, 0.1, 1}, news, {});
  }
  RelayHoming flown(LandingStrategy strategy) {
    RelayHoming out = homing(strategy);
    fly(out, -27, 25);
    return out;
  }
  std::optional<LandingSpot> spot(const RelayHoming& homing) const {
    return homing.spot_from(map, roadmap, far, kAlways);
  }
};

TEST_F(Flown, LandsWhereTheRadioBeginsToReachOnGoodGround) {
  for (const LandingStrategy strategy : {LandingStrategy::relay_chain, LandingStrategy::relay_tree}) {
    const auto s = spot(flown(strategy));
    ASSERT_TRUE(s) << name_of(strategy);
    // 50 m less 6 dB to spare: 25 m. Poses are judged every few metres.
    EXPECT_LE((s->ground - base).norm(), 25.1) << name_of(strategy);
    EXPECT_GE((s->ground - base).norm(), 18) << name_of(strategy);
    EXPECT_EQ(s->node, kBase);
    EXPECT_FALSE(s->claimed);
    EXPECT_NEAR(s->ground.z(), 0, 1e-9);
    EXPECT_LT((s->hover - s->ground).head<2>().norm(), 1e-9);
    EXPECT_EQ(ground_below(map, s->hover, kRadius, options.landing.ground).verdict, GroundVerdict::good);
    EXPECT_TRUE(roadmap.find(map, far, s->hover).found());
    EXPECT_NEAR(s->length_m, (far - s->hover).norm(), 0.15 * s->length_m);
    EXPECT_GE(s->time_s, flight_time_s(s->length_m, limits) +
                             (s->hover - s->ground).z() / options.landing.landing_speed_mps);
  }
  EXPECT_FALSE(spot(flown(LandingStrategy::return_to_base)));
}

// What is asked of the places in two rounds, the near ones first, is what asking each alone finds.
TEST_F(Flown, NoOtherPlaceIsSooner) {
  const RelayHoming homing = flown(LandingStrategy::relay_chain);
  for (double x = -27; x <= 25; x += 4) {
    const Vec3 from(x, 0.9, 1.1);
    std::set<double> times;
    RelayHoming rest = homing;
    while (const auto s = rest.spot_from(map, roadmap, from, kAlways)) {
      times.insert(s->time_s);
      rest.give_up(s->hover);
    }
    ASSERT_GE(times.size(), 5u);
    const double min_s = homing.spot_from(map, roadmap, from, kAlways)->time_s;
    EXPECT_EQ(min_s, *times.begin());
    EXPECT_FALSE(homing.spot_from(map, roadmap, from, min_s));
    EXPECT_EQ(homing.spot_from(map, roadmap, from, min_s + 0.01)->time_s, min_s);
  }
}

TEST_F(Flown, KeepsApartFromTakenPlacesAndFromWhereItWasInVain) {
  for (const LandingStrategy strategy : {LandingStrategy::relay_chain, LandingStrategy::relay_tree}) {
    RelayHoming homing = flown(strategy);
    const LandingSpot first = *spot(homing);
    homing.give_up(first.hover);
    const LandingSpot second = *spot(homing);
    EXPECT_GT((second.hover - first.hover).norm(), 0.5);
    news.taken = {second.ground};
    fly(homing, 25, 25);
    const LandingSpot third = *spot(homing);
    EXPECT_GE((third.ground - second.ground).norm(), options.landing.separation_m);
    EXPECT_GT((third.hover - first.hover).norm(), 0.5);
  }
}

// As it was: robot 3 of a team tried seven places one beside the other, ten seconds each, of all of which the
// map promised the same link.
TEST_F(Flown, WhereNobodyIsHeardTheNextPlaceHasMoreToSpare) {
  for (const LandingStrategy strategy : {LandingStrategy::relay_chain, LandingStrategy::relay_tree}) {
    RelayHoming homing = flown(strategy);
    const LandingSpot first = *spot(homing);
    homing.no_contact_at(first);
    fly(homing, 25, 25);
    const LandingSpot second = *spot(homing);
    EXPECT_LE((second.ground - base).norm(), 25.1 / std::pow(10, 3.0 / 20)) << name_of(strategy) << ": 3 dB";
  }
}

// As it was: of a claim that it had waited for in vain it tried four places more.
TEST_F(Flown, WhoIsAwaitedInVainIsNotCountedOnBeforeItIsKnownToStandSomewhere) {
  RelayHoming homing = flown(LandingStrategy::relay_chain);
  const Vec3 claimed(-5, 0.1, 0.3), elsewhere(-8, 0.1, 0.3);
  news.relays.push_back({2, claimed, claimed + Vec3(0, 0, 1), 500 * kSecond});
  fly(homing, 25, 25);
  ASSERT_TRUE(spot(homing)->claimed);
  homing.no_contact_at(*spot(homing));
  fly(homing, 25, 25);
  EXPECT_EQ(spot(homing)->node, kBase);
  news.relays.back() = {2, elsewhere, elsewhere + Vec3(0, 0, 1), 500 * kSecond};
  fly(homing, 25, 25);
  EXPECT_EQ(spot(homing)->node, 2) << "it claims another place";
  homing.no_contact_at(*spot(homing));
  news.relays.back().stands_by.reset();
  fly(homing, 25, 25);
  EXPECT_EQ(spot(homing)->node, 2) << "it stands there";
}

// It is not taken for one awaited in vain: it stands there, and a place nearer to it may be in contact.
TEST_F(Flown, OfARelayThatLandedMeanwhileAndIsNotHeardTheNextPlaceHasMoreToSpare) {
  RelayHoming homing = flown(LandingStrategy::relay_chain);
  const Vec3 ground(-5, 0.1, 0.3);
  news.relays.push_back({2, ground, ground + Vec3(0, 0, 1), 500 * kSecond});
  fly(homing, 25, 25);
  const LandingSpot first = *spot(homing);
  ASSERT_TRUE(first.claimed);
  news.relays.back().stands_by.reset();
  fly(homing, 25, 25);
  homing.no_contact_at(first);
  fly(homing, 25, 25);
  const LandingSpot second = *spot(homing);
  EXPECT_EQ(second.node, 2);
  EXPECT_LE((second.ground - ground).norm(), 25.1 / std::pow(10, 3.0 / 20)) << "3 dB";
}

TEST_F(Flown, DropsANodeWhereTheReachEndsAndNotBeforeOrBehind) {
  // 50 m less 6 dB to spare: 25 m from the base, which is at -28; 22 m with one more.
  RelayHoming homing = flown(LandingStrategy::return_to_base);
  const auto ends = [&](double x, double ahead) {
    return homing.relay_drop_site(map, {{x, 0.1, 1}}, {{ahead, 0.1, 1}});
  };
  ASSERT_TRUE(ends(-4, -2));
  EXPECT_LT((*ends(-4, -2) - Vec3(-4, 0.1, 0)).norm(), 0.2) << "straight below";
  EXPECT_FALSE(ends(-10, -8)) << "in reach yet";
  EXPECT_TRUE(ends(-7, -5)) << "a second on there is little to spare";
  EXPECT_FALSE(ends(-2, 0)) << "behind the end";
  news.relays.push_back({2, {0, 0.1, 0.3}, {0, 0.1, 1}});
  fly(homing, 24, 24);
  EXPECT_FALSE(ends(-4, -2)) << "in reach of the relay";
  EXPECT_TRUE(ends(24, 26));
  news.relays.back().stands_by = 500 * kSecond;
  fly(homing, 24, 24);
  EXPECT_TRUE(ends(-4, -2)) << "the relay is yet to land";
  EXPECT_FALSE(homing.relay_drop_site(map, {{-4, 0.1, 60}}, {{-2, 0.1, 60}})) << "unknown, and no ground";
}

// As it was: by a fall of 0.4 s whatever the height a node came to lie 0.7 m farther on than was reckoned
// with, over a ledge and out of reach.
TEST_F(Flown, DropsNoNodeThatFallsOutOfReach) {
  RelayHoming homing = flown(LandingStrategy::return_to_base);
  const auto ends = [&](double x, double vx_mps) {
    return homing.relay_drop_site(map, {{x, 0.1, 1}, {vx_mps, 0, 0}}, {{x + vx_mps, 0.1, 1}, {vx_mps, 0, 0}});
  };
  const auto flat = ends(-4, 1.5);
  ASSERT_TRUE(flat);
  EXPECT_NEAR(flat->x(), -4 + 1.5 * std::sqrt(2 * 1 / 9.81), 0.15) << "it flies on while it falls";
  for (int x = -20; x < 10; ++x)  // a pit from -4 on, two metres deep
    for (int y = -10; y < 10; ++y)
      for (int z = -11; z < 0; ++z) map.assign({x, y, z}, 1, z > -11 ? -2.0f : 2.0f);
  EXPECT_FALSE(ends(-4.4, 1.5)) << "0.4 m before the edge";
  const auto before = ends(-5.4, 1.5);
  ASSERT_TRUE(before) << "what is dropped here does not fall in, a second on it would";
  EXPECT_NEAR(before->z(), 0, 0.11);
}

TEST_F(Flown, CountsOnARelayAndOnOneThatWillStandInTime) {
  RelayHoming homing = flown(LandingStrategy::relay_chain);
  const double alone_m = spot(homing)->length_m;
  const Vec3 landed(-5, 0.1, 0.3);
  news.relays.push_back({2, landed, landed + Vec3(0, 0, 1)});
  fly(homing, 25, 25);
  EXPECT_EQ(spot(homing)->node, 2);
  EXPECT_LT(spot(homing)->length_m, alone_m - 15);

  news.relays.back().stands_by = 500 * kSecond;  // its own battery ends after 600
  fly(homing, 25, 25);
  EXPECT_TRUE(spot(homing)->claimed);
  news.relays.back().stands_by = 580 * kSecond;  // too late to count on
  fly(homing, 25, 25);
  EXPECT_EQ(spot(homing)->node, kBase);
  EXPECT_NEAR(spot(homing)->length_m, alone_m, 1e-9);
}

TEST_F(Flown, BehindAFallOfRockThereIsNoPlaceAndAroundItMayBeOne) {
  RelayHoming homing = flown(LandingStrategy::relay_chain);
  std::vector<CellChange> fall;
  std::vector<CellKey> closed;
  for (int y = -12; y < 12; ++y)
    for (int z = 0; z < 16; ++z) {
      map.assign({50, y, z}, 1, 2.0f);
      fall.push_back({{50, y, z}, Cell::free, Cell::occupied});
      closed.push_back({50, y, z});
    }
  roadmap.update(map, fall);
  homing.update(map, roadmap, far, news, closed);
  EXPECT_FALSE(spot(homing));
  // Where it is somebody reaches the base; of the last poses the ground was not judged yet.
  const Vec3 other(14, 0.1, 0.3);
  news.relays.push_back({2, other, other + Vec3(0, 0, 1)});
  homing.update(map, roadmap, far, news, {});
  const auto before = spot(homing);
  homing.look_around(map, roadmap, far);
  const auto after = spot(homing);
  ASSERT_TRUE(after);
  EXPECT_LT((after->hover - far).norm(), 4);
  EXPECT_TRUE(!before || before->time_s >= after->time_s);
}

TEST(RelayHomingInACave, EveryPlaceIsOnTheRockItselfClearOfItAndReachable) {
  cave::CaveRecipe recipe = cave::cave_preset("small");
  recipe.volume_m3 = 900, recipe.grid_m = 0.4;
  const cave::GeneratedCave made = cave::generate_cave(recipe, 4);
  const cave::RayScene scene(made.mesh);
  const bench::CaveMap drawn = bench::map_of_cave(made.mesh, made.start.position);
  const PlanningOptions planning;
  Roadmap roadmap{planning};
  roadmap.update(drawn.map, testing::all_cells(drawn.map));
  const Vec3 base = made.start.position;
  const HomingOptions options;
  RelayHoming homing(1, {team_with(LandingStrategy::relay_chain), options, planning, {}, kRadius, base});
  const TeamNews news = hearing(base);
  for (const auto& axis : made.axes)
    for (const Vec3& p : axis)
      if (roadmap.approach(drawn.map, p, 0)) homing.update(drawn.map, roadmap, p, news, {});
  std::size_t places = 0;
  for (; const auto s = homing.spot_from(drawn.map, roadmap, base, kAlways); ++places) {
    homing.give_up(s->hover);
    // The map's floor is the top of a cell that holds rock: the rock is at most a cell lower.
    EXPECT_NEAR(scene.ray_cast(s->hover, -Vec3::UnitZ(), 10), (s->hover - s->ground).z(), 0.25);
    // On the way down the vehicle's sphere touches nothing, until it comes to what the floor's roughness may
    // be.
    for (double z = s->ground.z() + kRadius + 0.3; z < s->hover.z(); z += 0.1)
      EXPECT_GE(scene.distance_to_rock({s->hover.x(), s->hover.y(), z}, 1), kRadius) << s->hover.transpose();
    EXPECT_TRUE(roadmap.find(drawn.map, base, s->hover).found());
    EXPECT_GE(expected_margin_db(drawn.map, s->ground + Vec3(0, 0, kRadius), base, options.landing.link), 0);
  }
  EXPECT_GE(places, 4u);
}

}  // namespace
}  // namespace karst::core
