#include "sdk/preflight/far_places.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/unit/selection/drawn_space.h"

namespace karst::preflight {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr core::SteepestView kLevelSight{30 * kDegree_rad, 30 * kDegree_rad};
constexpr core::SteepestView kAllRound{90 * kDegree_rad, 90 * kDegree_rad};

/// A level tube of 40 m towards the east.
selection::FreeSpace level_tube() {
  return test::space_of(test::tube({{0, 0, 0}, {40, 0, 0}}, 2), {-3, -3, -3}, {43, 3, 3});
}

/// The same, and a shaft of 20 m up from its end.
selection::FreeSpace tube_with_shaft() {
  return test::space_of(
      test::either(test::tube({{0, 0, 0}, {40, 0, 0}}, 2), test::tube({{40, 0, 0}, {40, 0, 20}}, 2)),
      {-3, -3, -3}, {43, 3, 23});
}

TEST(FarPlaces, TheFarthestIsAtTheOtherEnd) {
  // Both ends are half balls: cells with 0.6 m of clearance reach 1.4 m beyond the axis.
  EXPECT_NEAR(far_places(level_tube(), {0, 0, 0}, kAllRound).farthest_m, 41.4, 2.5);
  EXPECT_NEAR(far_places(level_tube(), {20, 0, 0}, kAllRound).farthest_m, 21.4, 2.0);
}

TEST(FarPlaces, ALevelTubeNeedsNoSightUpOrDown) {
  const FarPlaces far = far_places(level_tube(), {0, 0, 0}, kLevelSight);
  EXPECT_EQ(far.blind_fraction, 0);
  EXPECT_EQ(far.blind_climb, "");
}

TEST(FarPlaces, AShaftIsBlindWithoutSightUp) {
  const FarPlaces blind = far_places(tube_with_shaft(), {0, 0, 0}, kLevelSight);
  EXPECT_GT(blind.blind_fraction, 0.15) << "a third of the way is the shaft";
  EXPECT_LT(blind.blind_fraction, 0.45);
  EXPECT_NE(blind.blind_climb.find("m up within"), std::string::npos) << blind.blind_climb;
  EXPECT_EQ(far_places(tube_with_shaft(), {0, 0, 0}, kAllRound).blind_fraction, 0);
}

TEST(FarPlaces, FromTheTopOfTheShaftTheWayIsDown) {
  const FarPlaces blind = far_places(tube_with_shaft(), {40, 0, 20}, kLevelSight);
  EXPECT_GT(blind.blind_fraction, 0.6) << "all of the tube lies behind the shaft";
  EXPECT_NE(blind.blind_climb.find("m down within"), std::string::npos) << blind.blind_climb;
}

TEST(FarPlaces, OfNoSpaceThereAreNone) {
  const FarPlaces far = far_places(selection::FreeSpace{}, {0, 0, 0}, kAllRound);
  EXPECT_EQ(far.farthest_m, 0);
  EXPECT_EQ(far.blind_fraction, 0);
}

}  // namespace
}  // namespace karst::preflight
