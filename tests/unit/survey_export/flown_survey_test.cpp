// Where a flight's survey has its stations, and what it says of them, in caves whose shape is known.
#include "sdk/survey_export/flown_survey.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <set>

#include "core_stack/common/error.h"
#include "tests/unit/survey_export/carved_map.h"

namespace karst::survey_export {
namespace {

using core::Vec3;
using test::box;
using test::carved;
using test::surveyed;
using test::way;

std::vector<int> degrees(const survey::Survey& s) {
  std::vector<int> out(s.stations.size());
  for (const survey::Leg& l : s.legs) {
    ++out[l.from];
    ++out[l.to];
  }
  return out;
}
std::size_t count(const std::vector<int>& degrees, int degree) {
  return static_cast<std::size_t>(std::count(degrees.begin(), degrees.end(), degree));
}

/// What holds of every survey: legs as long as their stations are apart, at most 10 m, through free cells.
void expect_sound(const core::VoxelMap& map, const FlownSurvey& flown) {
  const survey::Survey& s = flown.survey;
  ASSERT_EQ(flown.leg_sd_m.size(), s.legs.size());
  EXPECT_EQ(flown.blocked_legs, 0u);
  for (const survey::Leg& l : s.legs) {
    const Vec3 &a = s.stations[l.from].position_m, &b = s.stations[l.to].position_m;
    EXPECT_FALSE(map.first_not_free(a, b)) << s.stations[l.from].name << " " << s.stations[l.to].name;
    EXPECT_LE(*l.length_m, 10.001);
    EXPECT_NEAR(*l.length_m, (b - a).norm(), 1e-9);
    if (!l.bearing_rad) continue;
    const Vec3 measured(std::sin(*l.bearing_rad) * std::cos(*l.inclination_rad),
                        std::cos(*l.bearing_rad) * std::cos(*l.inclination_rad),
                        std::sin(*l.inclination_rad));
    EXPECT_LT((*l.length_m * measured - (b - a)).norm(), 1e-6);
  }
  ASSERT_FALSE(s.stations.empty());
  EXPECT_TRUE(s.stations[0].entrance && s.stations[0].fixed);
  for (std::size_t i = 1; i < s.stations.size(); ++i)
    EXPECT_FALSE(s.stations[i].entrance || s.stations[i].fixed || s.stations[i].surface);
}

double nearest_station_m(const FlownSurvey& flown, const Vec3& p) {
  double nearest_m = 1e9;
  for (const survey::Station& s : flown.survey.stations)
    nearest_m = std::min(nearest_m, (s.position_m - p).norm());
  return nearest_m;
}

double distance_m(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double part = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - part * (b - a)).norm();
}
double level_distance_m(Vec3 p, Vec3 a, Vec3 b) {
  p.z() = a.z() = b.z() = 0;
  return distance_m(p, a, b);
}

/// The largest distance of these places from the survey's legs.
double farthest_from_legs_m(const FlownSurvey& flown, const std::vector<Vec3>& places) {
  double farthest_m = 0;
  for (const Vec3& p : places) {
    double nearest_m = 1e9;
    for (const survey::Leg& l : flown.survey.legs)
      nearest_m = std::min(nearest_m, distance_m(p, flown.survey.stations[l.from].position_m,
                                                 flown.survey.stations[l.to].position_m));
    farthest_m = std::max(farthest_m, nearest_m);
  }
  return farthest_m;
}

TEST(FlownSurvey, AStraightTunnelHasItsStationsOnTheAxisAndItsWallsWithinACell) {
  const core::VoxelMap map = test::tunnel_map();
  const FlownSurvey flown = surveyed(map, test::tunnel_flight());
  expect_sound(map, flown);
  const survey::Survey& s = flown.survey;
  EXPECT_LE(s.legs.size(), 6u);
  double least = 30, most = 0;
  for (const survey::Station& at : s.stations) {
    EXPECT_NEAR(at.position_m.y(), 0, 0.2) << at.name;
    EXPECT_NEAR(at.position_m.z(), 1.5, 0.2) << at.name;
    least = std::min(least, at.position_m.x());
    most = std::max(most, at.position_m.x());
  }
  EXPECT_LT(least, 2);
  EXPECT_GT(most, 29);
  for (const survey::Section& section : s.sections) {
    const Vec3& p = s.stations[section.station].position_m;
    const double turn = section.facing.x();  // along the tunnel, or against it
    ASSERT_NEAR(std::abs(turn), 1, 0.05);
    const survey::Dimensions& d = section.dimensions;
    ASSERT_TRUE(d.left_m && d.right_m && d.up_m && d.down_m);
    EXPECT_NEAR(*d.left_m, turn > 0 ? 2 - p.y() : 2 + p.y(), 0.2);
    EXPECT_NEAR(*d.right_m, turn > 0 ? 2 + p.y() : 2 - p.y(), 0.2);
    EXPECT_NEAR(*d.up_m, 3 - p.z(), 0.2);
    EXPECT_NEAR(*d.down_m, p.z(), 0.2);
  }
  for (const survey::Leg& l : s.legs) EXPECT_FALSE(l.approximate);
  for (const survey::Station& at : s.stations) EXPECT_FALSE(at.continuation) << at.name;
}

TEST(FlownSurvey, ABendHasAStation) {
  const auto cave = test::any_of({box({0, -1.6, 0}, {20, 1.4, 3}), box({17, -1.6, 0}, {20, 20, 3})});
  const core::VoxelMap map = carved(cave, {-1, -3, -1}, {21, 21, 4});
  const FlownSurvey flown = surveyed(map, way({{1, 0, 1.5}, {18.5, 0, 1.5}, {18.5, 19, 1.5}}));
  expect_sound(map, flown);
  const std::vector<int> d = degrees(flown.survey);
  EXPECT_EQ(count(d, 1), 2u);
  EXPECT_EQ(count(d, 2), d.size() - 2);
  EXPECT_LT(nearest_station_m(flown, {18.5, 0, 1.5}), 0.7);
  EXPECT_LT(farthest_from_legs_m(flown, way({{2, -0.1, 1.5}, {18.5, -0.1, 1.5}, {18.5, 18, 1.5}})), 0.6);
}

/// Along this axis, its floor and ceiling half the height below and above; by a seed other than 0, rock
/// stands out by up to a cell.
struct Passage {
  std::vector<Vec3> axis;
  double half_width_m = 1.7, half_height_m = 1.5;
  unsigned seed = 0;

  test::Inside inside() const {
    auto random = std::make_shared<std::mt19937>(seed);
    auto bumps = std::make_shared<std::map<std::array<int, 3>, double>>();
    return [*this, random, bumps](const Vec3& p) {
      double away_m = 100, up_m = 0;
      for (std::size_t i = 1; i < axis.size(); ++i) {
        const double m = level_distance_m(p, axis[i - 1], axis[i]);
        if (m >= away_m) continue;
        const Vec3 leg = axis[i] - axis[i - 1];
        const double f = (p - axis[i - 1]).head<2>().dot(leg.head<2>()) / leg.head<2>().squaredNorm();
        away_m = m;
        up_m = p.z() - axis[i - 1].z() - std::clamp(f, 0.0, 1.0) * leg.z();
      }
      const std::array<int, 3> place{static_cast<int>(std::floor(p.x() / 0.6)),
                                     static_cast<int>(std::floor(p.y() / 0.6)),
                                     static_cast<int>(std::floor(p.z() / 0.6))};
      const auto [bump, is_new] = bumps->try_emplace(place, 0);
      if (is_new && seed != 0) bump->second = 0.2 * static_cast<double>((*random)() % 100) / 100;
      return away_m + bump->second < half_width_m && std::abs(up_m) + bump->second < half_height_m;
    };
  }
};

TEST(FlownSurvey, BendsAreNotCut) {
  // Legs of 10 m that turn by 30 to 60 degrees: a line halfway between the walls turns where they do.
  const std::vector<Vec3> axis = {{0, 0, 1.5},   {10, 0, 1.5},  {18, 6, 1.5},   {27, 6.5, 1.5},
                                  {32, 15, 1.5}, {41, 12, 1.5}, {50, 16.5, 1.5}};
  const core::VoxelMap map = carved(Passage{axis}.inside(), {-3, -3, -1}, {53, 20, 4});
  const FlownSurvey flown = surveyed(map, way(axis));
  expect_sound(map, flown);
  EXPECT_LT(farthest_from_legs_m(flown, way(axis)), 0.35);
  EXPECT_LE(flown.survey.legs.size(), 16u);
}

TEST(FlownSurvey, ABendOf39DegreesInRoughRockIsNotCut) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    const Eigen::AngleAxisd turned(0.3 * seed, Vec3::UnitZ());
    const std::vector<Vec3> axis = {Vec3(0, 0, 1.5), turned * Vec3(10, -2.5, 1.5),
                                    turned * Vec3(16.2, -10.3, 1.5)};
    const core::VoxelMap map = carved(Passage{axis, 2, 1.5, seed}.inside(), {-22, -22, -1}, {22, 22, 4});
    const FlownSurvey flown = surveyed(map, way(axis));
    expect_sound(map, flown);
    EXPECT_LT(farthest_from_legs_m(flown, {axis[1]}), 0.25) << seed;
  }
}

TEST(FlownSurvey, AnEvenCurveIsNoCorner) {
  for (const double radius_m : {5.0, 8.0}) {
    std::vector<Vec3> axis = {{-8, 0, 1.5}};
    for (int degree = 0; degree <= 90; degree += 3) {
      const double a = degree * std::numbers::pi / 180;
      axis.emplace_back(radius_m * std::sin(a), radius_m * (1 - std::cos(a)), 1.5);
    }
    axis.emplace_back(radius_m, radius_m + 8, 1.5);
    const core::VoxelMap map =
        carved(Passage{axis}.inside(), {-11, -3, -1}, {radius_m + 3, radius_m + 11, 4});
    const FlownSurvey flown = surveyed(map, way(axis));
    expect_sound(map, flown);
    EXPECT_LT(farthest_from_legs_m(flown, way(axis)), 0.35) << radius_m;
  }
}

TEST(FlownSurvey, TheLastLegInRoughRockGoesDownAsThePassageDoes) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    const std::vector<Vec3> axis = {{0, 0, 1.5}, {17.3, 6.1, 1.5 - 0.03 * seed}};
    const core::VoxelMap map = carved(Passage{axis, 1.7, 1.5, seed}.inside(), {-3, -3, -4}, {21, 9, 4});
    const FlownSurvey flown = surveyed(map, way(axis));
    expect_sound(map, flown);
    const survey::Station& last = flown.survey.stations[flown.survey.legs.back().to];
    const Vec3 off = last.position_m - axis[0], leg = axis[1] - axis[0];
    const double slope = leg.z() / leg.head<2>().norm();
    EXPECT_LT(std::abs(off.z() - slope * off.head<2>().norm()), 0.2) << seed;
  }
}

TEST(FlownSurvey, ANicheBesideAStationIsNoWidth) {
  // A tunnel with a niche of 3 m, 0.6 m wide, every 4 m on one side.
  std::vector<test::Inside> parts = {test::tunnel()};
  for (double x = 2; x < 29; x += 4) parts.push_back(box({x, 1, 0.6}, {x + 0.6, 5, 2.4}));
  const core::VoxelMap map = carved(test::any_of(parts), {-1, -3, -1}, {31, 6, 4});
  const FlownSurvey flown = surveyed(map, test::tunnel_flight());
  for (const survey::Section& s : flown.survey.sections) {
    ASSERT_TRUE(s.dimensions.left_m && s.dimensions.right_m);
    EXPECT_NEAR(*s.dimensions.left_m + *s.dimensions.right_m, 4.2, 0.4);
  }
}

TEST(FlownSurvey, InATightRoughMeanderTheLineDoesNotFold) {
  std::vector<Vec3> axis = {{0, 0, 1.2}};
  for (int i = 0; i < 14; ++i) axis.emplace_back(axis.back() + Vec3(2.2, i % 2 == 0 ? 1.8 : -1.8, 0));
  for (const unsigned seed : {1u, 2u, 3u}) {
    const core::VoxelMap map = carved(Passage{axis, 1.2, 1.2, seed}.inside(), {-3, -3, -1}, {35, 5, 4});
    const FlownSurvey flown = surveyed(map, way(axis));
    expect_sound(map, flown);
    double length_m = 0;
    for (const survey::Leg& l : flown.survey.legs) length_m += *l.length_m;
    const double axis_m = 14 * std::hypot(2.2, 1.8);
    EXPECT_LT(length_m, 1.15 * axis_m) << "seed " << seed;
    EXPECT_GT(length_m, 0.75 * axis_m) << "seed " << seed;
    const std::vector<survey::Station>& s = flown.survey.stations;
    for (const survey::Leg& a : flown.survey.legs)
      for (const survey::Leg& b : flown.survey.legs)
        if (a.to == b.from) {
          const Vec3 u = (s[a.to].position_m - s[a.from].position_m).normalized(),
                     v = (s[b.to].position_m - s[b.from].position_m).normalized();
          EXPECT_GT(u.dot(v), -0.7) << "seed " << seed << ": it turns back at " << s[a.to].name;
        }
  }
}

TEST(FlownSurvey, AFlownPassageBelongsToItHoweverNarrowTheMapIsThere) {
  const auto cave = test::any_of(
      {box({0, -2, 0}, {12, 2, 3}), box({11, -0.45, 1}, {19, 0.45, 1.9}), box({18, -2, 0}, {30, 2, 3})});
  const core::VoxelMap map = carved(cave, {-1, -3, -1}, {31, 3, 4});
  const FlownSurvey not_flown = surveyed(map, way({{1, 0, 1.5}, {10, 0, 1.5}}));
  for (const survey::Station& s : not_flown.survey.stations) EXPECT_LT(s.position_m.x(), 15);
  const FlownSurvey flown = surveyed(map, way({{1, 0, 1.5}, {28, 0, 1.5}, {1, 0, 1.5}}));
  expect_sound(map, flown);
  EXPECT_LT(farthest_from_legs_m(flown, way({{2, 0, 1.5}, {28, 0, 1.5}})), 0.5);
  for (const survey::Leg& l : flown.survey.legs) EXPECT_FALSE(l.approximate);
}

TEST(FlownSurvey, AChangeOfSizeHasAStation) {
  const auto cave = test::any_of({box({0, -1, 0}, {15, 1, 2}), box({15, -4, 0}, {30, 4, 6})});
  const core::VoxelMap map = carved(cave, {-1, -5, -1}, {31, 5, 7});
  const FlownSurvey flown = surveyed(map, way({{1, 0, 1}, {14, 0, 1}, {28, 0, 2}}));
  expect_sound(map, flown);
  double nearest = 100;
  for (const survey::Station& s : flown.survey.stations)
    nearest = std::min(nearest, std::abs(s.position_m.x() - 15));
  EXPECT_LT(nearest, 2.0);
}

TEST(FlownSurvey, AJunctionIsOneStationOfThreeBranches) {
  const core::VoxelMap map = test::tee_map();
  const FlownSurvey flown =
      surveyed(map, way({{1, 0, 1.5}, {15, 0, 1.5}, {15, 14, 1.5}, {15, 0, 1.5}, {29, 0, 1.5}}));
  expect_sound(map, flown);
  const std::vector<int> d = degrees(flown.survey);
  EXPECT_EQ(count(d, 3), 1u);
  EXPECT_EQ(count(d, 1), 3u);
  for (std::size_t i = 0; i < d.size(); ++i)
    if (d[i] == 3) {
      EXPECT_LT((flown.survey.stations[i].position_m - Vec3(14.9, 0, 1.5)).norm(), 0.4)
          << "where the axes of the branches meet";
    }
  std::set<std::uint32_t> runs;
  for (const survey::Leg& l : flown.survey.legs) runs.insert(l.run);
  EXPECT_EQ(runs.size(), 3u);
}

TEST(FlownSurvey, AtAJunctionARayAlongAnotherPassageGivesNoWidth) {
  const core::VoxelMap map = test::tee_map();
  const FlownSurvey flown =
      surveyed(map, way({{1, 0, 1.5}, {15, 0, 1.5}, {15, 14, 1.5}, {15, 0, 1.5}, {29, 0, 1.5}}));
  const std::vector<int> d = degrees(flown.survey);
  std::size_t at_junction = 0;
  for (const survey::Section& s : flown.survey.sections) {
    const survey::Dimensions& m = s.dimensions;
    for (const std::optional<double>& wall_m : {m.left_m, m.right_m})
      if (wall_m) {
        EXPECT_LT(*wall_m, 4) << "the widest passage has 4 m between its walls";
      }
    EXPECT_TRUE(m.up_m && m.down_m);
    if (d[s.station] != 3) continue;
    ++at_junction;
    const double across = std::abs(s.facing.x());  // 1: the tunnel's section, 0: the branch's
    EXPECT_EQ(m.left_m.has_value() + m.right_m.has_value(), across > 0.9 ? 1 : 0) << across;
    const Vec3& p = flown.survey.stations[s.station].position_m;
    if (across > 0.99) {
      EXPECT_NEAR(m.left_m ? *m.left_m : *m.right_m, 2 + p.y(), 0.3);  // the wall opposite to the branch
    }
  }
  EXPECT_EQ(at_junction, 3u);
}

TEST(FlownSurvey, ADeadEndHasItsLastStationNearTheRockAndDoesNotGoOn) {
  const core::VoxelMap map = test::tunnel_map();
  const FlownSurvey flown = surveyed(map, test::tunnel_flight());
  const survey::Station& last = flown.survey.stations[flown.survey.legs.back().to];
  EXPECT_NEAR(last.position_m.x(), 29.5, 0.4);
  EXPECT_FALSE(last.continuation);
}

TEST(FlownSurvey, AnEndInUnknownSpaceGoesOn) {
  const core::VoxelMap map = test::tunnel_map(box({22, -10, -10}, {50, 10, 10}));
  const FlownSurvey flown = surveyed(map, way({{1, 0, 1.5}, {20, 0, 1.5}}));
  expect_sound(map, flown);
  std::size_t continuations = 0;
  for (const survey::Station& s : flown.survey.stations)
    if (s.continuation) {
      ++continuations;
      EXPECT_NEAR(s.position_m.x(), 21, 1.6);
      EXPECT_FALSE(s.comment.empty());
    }
  EXPECT_EQ(continuations, 1u);
}

TEST(FlownSurvey, ALeftFrontierMarksTheNearestStationUnlessTheMapKnowsThePlaceByNow) {
  const core::VoxelMap map = test::tunnel_map(box({14, 1.9, 1}, {15, 10, 2}));  // a hole in the wall
  const Vec3 hole(14.5, 1.9, 1.5), wall(8, 1.9, 1.5);
  const FlownSurvey flown = surveyed(map, test::tunnel_flight(), {hole, wall});
  double least = 100;
  const survey::Station* nearest = nullptr;
  for (const survey::Station& s : flown.survey.stations)
    if (const double away = (s.position_m - hole).norm(); away < least) {
      least = away;
      nearest = &s;
    }
  for (const survey::Station& s : flown.survey.stations) EXPECT_EQ(s.continuation, &s == nearest) << s.name;
}

TEST(FlownSurvey, WhatWasSeenButNotFlownIsApproximate) {
  const core::VoxelMap map = test::tee_map();
  const FlownSurvey flown = surveyed(map, way({{1, 0, 1.5}, {29, 0, 1.5}}));
  std::size_t approximate = 0;
  for (const survey::Leg& l : flown.survey.legs) {
    const double y = flown.survey.stations[l.to].position_m.y();
    EXPECT_EQ(l.approximate, y > 3) << y;
    approximate += l.approximate ? 1u : 0u;
  }
  EXPECT_GE(approximate, 1u);
}

TEST(FlownSurvey, AShaftHasLegsStraightDownAndSectionsAcrossIt) {
  const core::VoxelMap map = carved(box({-2, -2, -25}, {2, 2, 0}), {-3, -3, -26}, {3, 3, 1});
  const FlownSurvey flown = surveyed(map, way({{0, 0, -2}, {0, 0, -24}}));
  expect_sound(map, flown);
  double deepest = 0;
  for (const survey::Station& s : flown.survey.stations) {
    EXPECT_LT(std::hypot(s.position_m.x(), s.position_m.y()), 0.3);
    deepest = std::min(deepest, s.position_m.z());
  }
  EXPECT_LT(deepest, -23.5);
  for (const survey::Section& s : flown.survey.sections) {
    ASSERT_TRUE(s.dimensions.left_m && s.dimensions.right_m);
    EXPECT_NEAR(*s.dimensions.left_m + *s.dimensions.right_m, 4.2, 0.4);
  }
}

TEST(FlownSurvey, ARingClosesAtItsFirstStation) {
  const auto outer = box({-10, -10, 0}, {10, 10, 3}), pillar = box({-7, -7, -1}, {7, 7, 4});
  const core::VoxelMap map =
      carved([&](const Vec3& p) { return outer(p) && !pillar(p); }, {-11, -11, -1}, {11, 11, 4});
  const FlownSurvey flown = surveyed(map, way({{0, -8.5, 1.5},
                                               {8.5, -8.5, 1.5},
                                               {8.5, 8.5, 1.5},
                                               {-8.5, 8.5, 1.5},
                                               {-8.5, -8.5, 1.5},
                                               {0, -8.5, 1.5}}));
  expect_sound(map, flown);
  EXPECT_EQ(flown.survey.legs.size(), flown.survey.stations.size());
  const std::vector<int> d = degrees(flown.survey);
  EXPECT_EQ(count(d, 2), d.size());
}

TEST(FlownSurvey, AMapWithoutAPassageAtTheStartIsRefused) {
  const core::VoxelMap map = test::tunnel_map();
  try {
    surveyed(map, {{500, 0, 0}});
    FAIL();
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("run: the map holds no passage"), std::string::npos) << e.what();
  }
  EXPECT_THROW(surveyed(map, {}), core::InputError);
}

TEST(FlownSurvey, ASurveysNameHasOnlyWhatSurvexAndTherionTake) {
  EXPECT_EQ(survey_name("My Cave.2"), "my_cave_2");
  EXPECT_EQ(survey_name(""), "cave");
  EXPECT_EQ(survey_name("-x-"), "_x-") << "Therion: invalid keyword -- -x";
}

}  // namespace
}  // namespace karst::survey_export
