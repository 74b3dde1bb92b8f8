#include "core_stack/mapping/prior/surveyed_passages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "core_stack/mapping/prior/unsurveyed_volume.h"

namespace karst::core {
namespace {

/// Distance to the nearest of points that fill a straight leg along x, which lie `step_m` apart.
double sampled_distance_m(const SurveyPrior& prior, const Vec3& p, double step_m) {
  const SurveyedLeg& leg = prior.legs.front();
  const PassageSize& s = leg.from_size;
  const double length_m = prior.stations[leg.to].x();
  double nearest_m = std::numeric_limits<double>::infinity();
  for (double x = 0; x <= length_m; x += step_m)
    for (double y = -s.right_m; y <= s.left_m; y += step_m)
      for (double z = -s.down_m; z <= s.up_m; z += step_m)
        nearest_m = std::min(nearest_m, (p - Vec3(x, y, z)).norm());
  return nearest_m;
}

SurveyPrior one_leg(const Vec3& to, const PassageSize& size) {
  return {{Vec3::Zero(), to}, {{0, 1, size, size}}, {}};
}

TEST(SurveyedPassages, TheDistanceOutsideIsThatToTheNearestPointOfThePassage) {
  const SurveyPrior prior = one_leg({6, 0, 0}, {1.0, 2.5, 3.0, 0.5});
  const SurveyedPassages passages(prior);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(-8, 12);
  constexpr double kStep_m = 0.1;
  int outside = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p(at(random), at(random), at(random));
    const double d = passages.distance_m(p), sampled = sampled_distance_m(prior, p, kStep_m);
    if (d > 0) {
      ++outside;
      EXPECT_LE(d, sampled + 1e-9) << p.transpose();
      EXPECT_GE(d, sampled - 2 * kStep_m) << p.transpose();
    } else {
      EXPECT_LE(sampled, 2 * kStep_m) << p.transpose();
    }
  }
  EXPECT_GT(outside, 100);
}

TEST(SurveyedPassages, InThePassageItIsLessTheWayToTheNearestWall) {
  const SurveyedPassages passages(one_leg({10, 0, 0}, {1, 2, 3, 0.5}));
  EXPECT_DOUBLE_EQ(passages.distance_m({5, 0, 0}), -0.5) << "the floor";
  EXPECT_DOUBLE_EQ(passages.distance_m({5, 0.75, 1}), -0.25) << "the left wall";
  EXPECT_DOUBLE_EQ(passages.distance_m({5, -1.875, 1}), -0.125) << "the right wall";
  EXPECT_DOUBLE_EQ(passages.distance_m({0.125, 0, 1}), -0.125) << "its end is flat";
}

TEST(SurveyedPassages, WidensFromOneEndToTheOther) {
  SurveyPrior prior = one_leg({10, 0, 0}, {1, 1, 1, 1});
  prior.legs[0].to_size.left_m = 3;
  const SurveyedPassages passages(prior);
  EXPECT_NEAR(passages.distance_m({5, 2.5, 0}), 0.5, 1e-12);
  EXPECT_NEAR(passages.distance_m({10, 2.5, 0}), 0.0, 1e-12);
  EXPECT_NEAR(passages.distance_m({5, -2.5, 0}), 1.5, 1e-12);
}

TEST(SurveyedPassages, AShaftIsAsDeepAsItIsWide) {
  const SurveyedPassages passages(one_leg({0, 0, -20}, {2, 2, 0.1, 7}));
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)})
    EXPECT_NEAR(passages.distance_m(Vec3(0, 0, -10) + 3 * side), 1.0, 1e-9) << side.transpose();
}

TEST(SurveyedPassages, LegsThatMeetFillTheBend) {
  SurveyPrior prior = one_leg({10, 0, 0}, {1, 1, 1, 1});
  EXPECT_NEAR(SurveyedPassages(prior).distance_m({10.5, 0, 0}), 0.5, 1e-12) << "nothing goes on here";
  prior.stations.emplace_back(10, 10, 0);
  prior.legs.push_back({1, 2, {1, 1, 1, 1}, {1, 1, 1, 1}});
  const SurveyedPassages bend(prior);
  EXPECT_LT(bend.distance_m({10.9, -0.9, 0}), 0) << "the outer corner";
  EXPECT_NEAR(bend.distance_m({10.5, 10.5, 0}), 0.5, 1e-12);
}

TEST(SurveyedPassages, TheNearestOfManyLegsIsFound) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> at(-60, 60), wall(0.2, 4);
  SurveyPrior prior;
  for (int i = 0; i < 200; ++i) prior.stations.emplace_back(at(random), at(random), 0.3 * at(random));
  for (std::uint32_t i = 0; i + 1 < 200; i += 2)  // none meet
    prior.legs.push_back({i,
                          i + 1,
                          {wall(random), wall(random), wall(random), wall(random)},
                          {wall(random), wall(random), wall(random), wall(random)}});
  const SurveyedPassages all(prior);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(at(random), at(random), 0.3 * at(random));
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const SurveyedLeg& leg : prior.legs)
      nearest_m = std::min(nearest_m, SurveyedPassages({prior.stations, {leg}, {}}).distance_m(p));
    EXPECT_DOUBLE_EQ(all.distance_m(p), nearest_m) << p.transpose();
  }
}

TEST(SurveyedPassages, WithoutALegNothingIsNear) {
  EXPECT_TRUE(std::isinf(SurveyedPassages({}).distance_m({0, 0, 0})));
  EXPECT_TRUE(std::isinf(SurveyedPassages(one_leg({0.001, 0, 0}, {})).distance_m({0, 0, 0})))
      << "a leg without a length has no direction";
}

TEST(SurveyedPassages, OnlySoundPriorsAreSound) {
  const SurveyPrior good{{Vec3(0, 0, 0), Vec3(1, 0, 0)}, {{0, 1, {}, {}}}, {{1, false}}};
  EXPECT_TRUE(is_sound(good));
  const auto with = [&good](auto change) {
    SurveyPrior p = good;
    change(p);
    return is_sound(p);
  };
  EXPECT_FALSE(with([](SurveyPrior& p) { p.stations[0].x() = NAN; }));
  EXPECT_FALSE(with([](SurveyPrior& p) { p.legs[0].to = 2; }));
  EXPECT_FALSE(with([](SurveyPrior& p) { p.legs[0].to = 0; }));
  EXPECT_FALSE(with([](SurveyPrior& p) { p.legs[0].to_size.up_m = -1; }));
  EXPECT_FALSE(with([](SurveyPrior& p) { p.legs[0].from_size.left_m = INFINITY; }));
  EXPECT_FALSE(with([](SurveyPrior& p) { p.leads[0].station = 2; }));
}

TEST(UnsurveyedVolume, CountsFreeCellsBeyondThePassagesAndTakesThemBack) {
  const auto survey = std::make_shared<const SurveyedPassages>(one_leg({10, 0, 0}, {1, 1, 1, 1}));
  UnsurveyedVolume volume(survey);
  const VoxelMap map{MapOptions{}};
  const double cell_m3 = std::pow(map.resolution_m(), 3);
  const CellKey inside = map.key_of({5, 0, 0}), rim = map.key_of({5, 1.5, 0}), beyond = map.key_of({5, 4, 0});
  const auto note = [&](const CellKey& k, Cell before, Cell after) {
    const CellChange change{k, before, after};
    volume.note(map, {&change, 1});
    return volume.m3();
  };
  EXPECT_EQ(note(inside, Cell::unknown, Cell::free), 0);
  EXPECT_EQ(note(rim, Cell::unknown, Cell::free), 0) << "less than kBeyondSurvey_m outside";
  EXPECT_EQ(note(beyond, Cell::unknown, Cell::occupied), 0);
  EXPECT_DOUBLE_EQ(note(beyond, Cell::occupied, Cell::free), cell_m3);
  EXPECT_DOUBLE_EQ(note(beyond, Cell::free, Cell::free), cell_m3);
  EXPECT_EQ(note(beyond, Cell::free, Cell::occupied), 0);
}

}  // namespace
}  // namespace karst::core
