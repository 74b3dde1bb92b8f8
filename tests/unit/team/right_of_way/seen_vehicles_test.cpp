// Vehicles that are seen and not heard.
#include "core_stack/team/right_of_way/seen_vehicles.h"

#include <gtest/gtest.h>

namespace karst::core {
namespace {

struct Sky {
  SeenVehicles seen;
  TimeNs now = 0;
  std::vector<Neighbour> heard;
  /// Ten times a second it is seen at the place that it flies on from at `v`.
  Vec3 fly(Vec3 place, const Vec3& v, double for_s) {
    for (int i = 0; i < static_cast<int>(10 * for_s); ++i) {
      now += kSecond / 10;
      place += 0.1 * v;
      seen.note(std::vector<Vec3>{place}, now, heard);
    }
    return place;
  }
};

TEST(SeenVehicles, OneThatFliesStopsForNobody) {
  Sky sky;
  const Vec3 place = sky.fly({5, 0, 1}, {-1, 0, 0}, 1);
  const auto all = sky.seen.neighbours(sky.now + kSecond / 2);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].phase, TeamPhase::landing);
  EXPECT_FALSE(all[0].heard);
  EXPECT_GE(all[0].robot, kMaxRobots) << "no robot's number";
  EXPECT_LT((all[0].velocity_mps - Vec3(-1, 0, 0)).norm(), 1e-6);
  EXPECT_LT((all[0].position - (place - Vec3(0.5, 0, 0))).norm(), 1e-6);
}

TEST(SeenVehicles, WhatNeverMovesIsNone) {
  Sky sky;
  sky.fly({5, 0, 1}, Vec3::Zero(), 3);
  EXPECT_TRUE(sky.seen.neighbours(sky.now).empty());
}

TEST(SeenVehicles, OneThatStandsWaitsAndIsRememberedForLonger) {
  Sky sky;
  const Vec3 place = sky.fly({5, 0, 1}, {-1, 0, 0}, 1);
  sky.fly(place, Vec3::Zero(), 1.5);
  const auto all = sky.seen.neighbours(sky.now + 5 * kSecond);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].phase, TeamPhase::aside);
  EXPECT_TRUE(all[0].velocity_mps.isZero());
  EXPECT_TRUE(sky.seen.neighbours(sky.now + 11 * kSecond).empty());
}

TEST(SeenVehicles, OneThatFliesOutOfSightIsForgotten) {
  Sky sky;
  sky.fly({5, 0, 1}, {-1, 0, 0}, 1);
  EXPECT_FALSE(sky.seen.neighbours(sky.now + kSecond).empty());
  EXPECT_TRUE(sky.seen.neighbours(sky.now + 4 * kSecond).empty());
}

TEST(SeenVehicles, NoiseThatJumpsAboutAndWhatIsTooFastAreNone) {
  Sky sky;
  for (int i = 0; i < 30; ++i) {
    sky.now += kSecond / 10;
    sky.seen.note(std::vector<Vec3>{{5 - 0.05 * i + (i % 2 ? 0.2 : -0.2), 0, 1}}, sky.now, {});
  }
  EXPECT_TRUE(sky.seen.neighbours(sky.now).empty()) << "it drifts, but not along a line";
  sky.fly({20, 0, 1}, {-5, 0, 0}, 2);
  EXPECT_TRUE(sky.seen.neighbours(sky.now).empty());
}

// As it was: of two that met at 3.4 m/s around a bend each was known to fly a second before they touched.
TEST(SeenVehicles, OneThatIsFastIsKnownSooner) {
  Sky sky;
  sky.fly({5, 0, 1}, {-1.7, 0, 0}, 0.3);
  EXPECT_EQ(sky.seen.neighbours(sky.now).size(), 1u);
  Sky slow;
  slow.fly({5, 0, 1}, {-0.8, 0, 0}, 0.3);
  EXPECT_TRUE(slow.seen.neighbours(slow.now).empty());
}

TEST(SeenVehicles, SeveralBodiesOfOneScanAreNotOneVehicle) {
  Sky sky;
  for (int i = 0; i < 4; ++i) {
    sky.now += kSecond / 10;
    sky.seen.note(std::vector<Vec3>{{5 - 0.09 * i, 0, 1}, {5.1 - 0.09 * i, 0.3, 1}}, sky.now, {});
  }
  EXPECT_TRUE(sky.seen.neighbours(sky.now).empty()) << "eight bodies, but four scans";
}

TEST(SeenVehicles, OneThatWasHiddenFliesOn) {
  Sky sky;
  const Vec3 place = sky.fly({9, 0, 1}, {-1, 0, 0}, 1);
  sky.now += 9 * kSecond / 10;
  sky.seen.note(std::vector<Vec3>{place - Vec3(1, 0, 0)}, sky.now, {});
  const auto all = sky.seen.neighbours(sky.now);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].phase, TeamPhase::landing);
  EXPECT_NEAR(all[0].velocity_mps.x(), -1, 0.2);
}

TEST(SeenVehicles, OneThatIsHeardAgainIsForgottenAsAStranger) {
  Sky sky;
  const Vec3 place = sky.fly({5, 0, 1}, {-1, 0, 0}, 1);
  ASSERT_EQ(sky.seen.neighbours(sky.now).size(), 1u);
  sky.seen.note({}, sky.now, std::vector<Neighbour>{{2, place, {-1, 0, 0}, TeamPhase::explore}});
  EXPECT_TRUE(sky.seen.neighbours(sky.now).empty());
}

TEST(SeenVehicles, ThousandsOfBodiesAreNotFollowed) {
  Sky sky;
  std::vector<Vec3> dust;
  for (int i = 0; i < 5000; ++i) dust.emplace_back(i % 50, i / 50 % 50, i / 2500);
  for (int i = 0; i < 100; ++i) sky.seen.note(dust, sky.now += kSecond / 10, {});
  EXPECT_TRUE(sky.seen.neighbours(sky.now).empty());
}

TEST(SeenVehicles, OneThatIsHeardIsNoOther) {
  Sky sky;
  sky.heard = {{3, {4.5, 0.5, 1}, Vec3::Zero(), TeamPhase::explore}};
  sky.fly({5, 0, 1}, {-1, 0, 0}, 1);
  EXPECT_TRUE(sky.seen.neighbours(sky.now).empty());
}

}  // namespace
}  // namespace karst::core
