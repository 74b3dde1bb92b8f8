#include "sdk/selection/select.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core_stack/common/error.h"
#include "sdk/campaign/store/store.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/selection/goal.h"
#include "sdk/selection/leave_one_out.h"
#include "sdk/selection/load_experience.h"
#include "sdk/selection/preset.h"
#include "sdk/selection/select_words.h"
#include "tests/unit/evaluation/reachable/boxes.h"
#include "tests/unit/selection/experiences.h"

namespace {

using namespace karst::selection;
using karst::core::InputError;
using karst::test::cave_figures;
using karst::test::experience;

std::string name_of_first(const Experience& e, const Selected& s) {
  return e.contestants[s.ranking.front().contestant].name;
}

TEST(Distance, IsZeroToItselfSymmetricAndGrowsWithTheDifference) {
  const Experience e = experience(12, 0.3, 0, 1);
  const std::vector<double> scales = robust_scales(e.caves);
  const CaveFigures a = cave_figures(0, 0.2);
  EXPECT_EQ(distance_between(a, a, scales).value, 0);
  double last = 0;
  for (const double size : {0.2, 0.5, 1.0, 3.0}) {
    const CaveFigures b = cave_figures(size, 0.2);
    const double d = distance_between(a, b, scales).value;
    EXPECT_EQ(d, distance_between(b, a, scales).value);
    EXPECT_GT(d, last);
    last = d;
  }
}

TEST(Distance, ByDefinition) {
  CaveFigures a, b;
  a.volume_m3 = 1000, b.volume_m3 = 1000 * std::exp(0.6);  // three units of 0.2, weight 1
  a.length_m = 100, b.length_m = 100 * std::exp(0.2);      // one unit of 0.2, weight 0.5
  a.width_m = 3;                                           // not known of the other
  std::vector<double> scales;
  for (const FigureDefinition& f : figure_definitions()) scales.push_back(f.min_scale);
  const Distance d = distance_between(a, b, scales);
  EXPECT_NEAR(d.value, std::sqrt((9 + 0.5) / 1.5), 1e-12);
  EXPECT_EQ(d.shared, 2);
  EXPECT_EQ(figure_definitions()[static_cast<std::size_t>(d.farthest)].name, "volume");
  EXPECT_TRUE(std::isnan(distance_between(a, CaveFigures{}, scales).value));
}

TEST(Distance, ScalesAreRobust) {
  std::vector<KnownCave> caves;
  for (const double v : {1.0, 2.0, 3.0, 4.0, 100.0}) {
    caves.push_back({"c", {}});
    caves.back().figures.verticality = v / 10;  // medians: 0.3, and 0.1 from it
  }
  for (std::size_t i = 0; i < figure_definitions().size(); ++i)
    if (figure_definitions()[i].name == "verticality")
      EXPECT_NEAR(robust_scales(caves)[i], 0.14826, 1e-9);
    else
      EXPECT_EQ(robust_scales(caves)[i], figure_definitions()[i].min_scale);
}

TEST(Select, NamesThePolicyThatDoesWellInCavesLikeIt) {
  const Experience e = experience(20, 0.3, 0.02, 3);
  const Selected steep = select(e, cave_figures(0, 0.7), {}, "cave"),
                 level = select(e, cave_figures(0, 0.1), {}, "cave");
  EXPECT_EQ(name_of_first(e, steep), "steep");
  EXPECT_EQ(name_of_first(e, level), "level");
  EXPECT_FALSE(steep.refused) << steep.reason;
  EXPECT_GT(steep.confidence, 0.8);
  EXPECT_LT(steep.fit.kernel.bandwidth, 3);
  EXPECT_EQ(steep.ranking.size(), 3u);
  for (std::size_t i = 1; i < steep.near.size(); ++i)
    EXPECT_LE(steep.near[i - 1].distance.value, steep.near[i].distance.value);
  double weight = 0;
  for (const NearCave& n : steep.near) weight += n.weight;
  EXPECT_NEAR(weight, 1, 1e-12);
}

// Reasons were cut after 399 characters.
TEST(Select, ReasonsAreWholeHoweverLongTheNames) {
  Experience e = experience(20, 0.3, 0.02, 3);
  for (Preset& p : e.contestants) p.name += std::string(500, 'x');
  for (KnownCave& c : e.caves) c.name += std::string(500, 'y');
  const Selected like = select(e, cave_figures(0, 0.7), {}, "cave");
  EXPECT_TRUE(like.reason.starts_with(name_of_first(e, like) + " did best in ")) << like.reason;
  EXPECT_NE(like.reason.find(e.caves[like.near.front().cave].name + " (distance"), std::string::npos);
  EXPECT_TRUE(like.reason.ends_with("in profile campaign.")) << like.reason;
  const Selected far = select(e, cave_figures(9, 0.7), {}, "cave");
  ASSERT_TRUE(far.refused);
  EXPECT_NE(far.reason.find("most unlike is its "), std::string::npos) << far.reason;
  EXPECT_TRUE(far.reason.ends_with(" in all")) << far.reason;
}

TEST(Select, IsTheSameEveryTime) {
  const Experience e = experience(9, 0.2, 0.1, 5);
  const Selected a = select(e, cave_figures(0.1, 0.5), {}, "cave"),
                 b = select(e, cave_figures(0.1, 0.5), {}, "cave");
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.confidence, b.confidence);
}

// The mean level times the mean of what the contestant did relative to the level.
TEST(Select, OfEqualCavesTheMeanIsExpected) {
  Experience e = experience(6, 0.2, 0, 7);
  for (KnownCave& c : e.caves) c.figures = cave_figures(0, 0.4);
  const Selected s = select(e, cave_figures(0, 0.4), {}, "cave");
  for (const Expected& x : s.ranking) {
    double level = 0, relative = 0;
    for (std::size_t c = 0; c < 6; ++c) {
      const double there = (e.at(0, c, 0).mean + e.at(1, c, 0).mean + e.at(2, c, 0).mean) / 3;
      level += there / 6;
      relative += e.at(x.contestant, c, 0).mean / there / 6;
    }
    EXPECT_NEAR(x.value, level * relative, 1e-12);
    EXPECT_NEAR(x.effective_caves, 6, 1e-9);
  }
}

TEST(Select, LessIsBetterOfTimes) {
  Experience e = experience(10, 0.3, 0, 3);
  const auto m = static_cast<std::size_t>(std::find(e.metrics.begin(), e.metrics.end(), "restricted_t90_s") -
                                          e.metrics.begin());
  for (std::size_t c = 0; c < e.caves.size(); ++c)
    for (std::size_t k = 0; k < 3; ++k) e.at(k, c, m) = {5, 100.0 + 10 * static_cast<double>(k), 1};
  const Selected s = select(e, cave_figures(0, 0.4), {"restricted_t90_s"}, "cave");
  EXPECT_EQ(name_of_first(e, s), "steep");
  EXPECT_NEAR(s.ranking.back().value, 120, 1e-9);
}

TEST(Select, IntervalsHoldAsManyCavesAsTheySay) {
  // 90 % intervals over 300 fresh caves of the same kind: within what 300 draws from a fixed experience allow
  // for, which itself may be a lucky or an unlucky one.
  int inside = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Experience e = experience(25, 0.3, 0.05, seed);
    Experience rest = e;
    for (int i = 0; i < 10; ++i) rest = without_cave(rest, rest.caves.size() - 1);
    for (std::size_t c = 15; c < 25; ++c) {
      const Selected s = select(rest, e.caves[c].figures, {}, "cave");
      for (const Expected& x : s.ranking) {
        const double truth = e.at(x.contestant, c, 0).mean;
        inside += truth >= x.low && truth <= x.high, ++all;
      }
    }
  }
  EXPECT_GT(inside, 0.85 * all);
  EXPECT_LT(inside, 0.97 * all);
}

std::size_t index_of(const Experience& e, const std::string& metric) {
  return static_cast<std::size_t>(std::find(e.metrics.begin(), e.metrics.end(), metric) - e.metrics.begin());
}

// As it was: of a small cave it expected more volume explored than it has, as in the larger caves like it.
TEST(Select, NeverExpectsMoreThanTheCaveHas) {
  Experience e = experience(12, 0.3, 0.02, 3);
  const std::size_t volume = index_of(e, "explored_volume_m3"), coverage = index_of(e, "coverage");
  for (std::size_t c = 0; c < e.caves.size(); ++c)
    for (std::size_t k = 0; k < 3; ++k) {
      e.at(k, c, volume) = {5, 0.9 * e.caves[c].figures.volume_m3 + 10 * static_cast<double>(k), 50};
      e.at(k, c, coverage) = {5, 0.98 - 0.01 * static_cast<double>(k), 0.05};
    }
  CaveFigures small = cave_figures(-1, 0.4);
  small.volume_m3 = 1000;  // less than was explored in any of the known caves, of 1839 m3 and more
  const Selected in_small = select(e, small, {"explored_volume_m3"}, "cave");
  EXPECT_EQ(name_of_first(e, in_small), "both") << "the order is by what was flown, not by the limit";
  for (const Expected& x : in_small.ranking) {
    EXPECT_LE(x.value, small.volume_m3);
    EXPECT_LE(x.high, small.volume_m3);
    EXPECT_GE(x.low, 0);
    EXPECT_LE(x.low, x.value);
  }
  const std::vector<double> expected = expected_figures(e, small, in_small, 0);
  EXPECT_NEAR(expected[volume], 1000 * expected[coverage], 1e-9) << "what is covered of it";
  EXPECT_LE(expected[coverage], 1);
  // Of a cave whose volume is not known nothing more can be said.
  CaveFigures unknown = small;
  unknown.volume_m3 = kUnknown;
  EXPECT_GT(expected_figures(e, unknown, select(e, unknown, {}, "cave"), 0)[volume], 1600);
}

TEST(Select, SharesAreSharesAndTheirIntervalsToo) {
  EXPECT_TRUE(rc::check("shares", [] {
    const auto seed = *rc::gen::inRange<std::uint64_t>(1, 1000);
    Experience e = experience(8, *rc::gen::inRange(0, 20) / 10.0, 0.5, seed);  // means below 0 and above 1
    karst::core::Random random(seed);
    for (const char* metric : {"coverage", "explored_volume_m3", "completed", "energy_wh"})
      for (std::size_t c = 0; c < e.caves.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
          e.at(k, c, index_of(e, metric)) = {3, random.uniform(-1, 3) * e.caves[c].figures.volume_m3, 0.1};
    const CaveFigures cave = cave_figures(random.uniform(-1, 1), random.uniform());
    for (const char* metric : {"coverage_auc", "coverage", "explored_volume_m3", "completed", "energy_wh"}) {
      const std::string name = metric;
      const double most = name == "explored_volume_m3" ? cave.volume_m3 : name == "energy_wh" ? 1e99 : 1.0;
      const Selected s = select(e, cave, {name}, "cave");
      for (const Expected& x : s.ranking)
        for (const double v : {x.value, x.low, x.high}) RC_ASSERT(v >= 0 && v <= most);
      for (std::size_t k = 0; k < 3; ++k) {
        const double v = expected_figures(e, cave, s, k)[index_of(e, name)];
        RC_ASSERT(v >= 0 && v <= most);
      }
    }
  }));
}

/// Under the first condition "steep" is the best everywhere, under the second "level".
Experience two_vehicles(int caves) {
  Experience e = experience(caves, 0, 0.02, 5);
  e.conditions.push_back(karst::test::condition("camera_uav", 300));
  lay_out(e, all_sites(e));
  karst::core::Random random(3);
  for (std::size_t s = 0; s < e.sites.size(); ++s) {
    const bool camera = e.sites[s].condition == 1;
    const double level = (camera ? 0.2 : 0.6) * random.uniform(0.9, 1.1);
    const double advantage[] = {camera ? -0.2 : 0.2, camera ? 0.2 : -0.2, 0.0};
    for (std::size_t k = 0; k < 3; ++k)
      e.at(k, s, 0) = {4, level * (1 + advantage[k] + 0.02 * random.normal()), 0.01};
  }
  return e;
}

TEST(Select, NamesThePolicyForTheVehicleThatIsAskedFor) {
  const Experience e = two_vehicles(8);
  const auto asked = [&](const std::string& vehicle) {
    return select(e, cave_figures(0.3, 0.4), {.conditions = {.vehicle = vehicle}}, "cave");
  };
  const Selected lidar = asked("lidar_uav"), camera = asked("camera_uav"), any = asked("");
  EXPECT_EQ(name_of_first(e, lidar), "steep");
  EXPECT_EQ(name_of_first(e, camera), "level");
  EXPECT_NEAR(lidar.ranking.front().value, 0.72, 0.05);
  EXPECT_NEAR(camera.ranking.front().value, 0.24, 0.03) << "the level is that of this vehicle";
  EXPECT_LT(camera.fit.kernel.other_vehicle, 0.2);
  EXPECT_EQ(camera.evidence.flights, 8u * 2 * 3 * 4);
  EXPECT_EQ(camera.evidence.flights_as_asked, 8u * 3 * 4);
  EXPECT_NE(
      camera.reason.find("It rests on 192 flights in 8 caves under 2 conditions, 96 of them in 8 caves as "
                         "asked (camera_uav); flights of other vehicles count "),
      std::string::npos)
      << camera.reason;
  EXPECT_EQ(any.evidence.flights_as_asked, any.evidence.flights);
}

TEST(Select, TheEnduranceDecidesWhereItMatters) {
  Experience e = experience(8, 0, 0.02, 5);
  e.conditions = {karst::test::condition("v", 240), karst::test::condition("v", 480)};
  lay_out(e, all_sites(e));
  karst::core::Random random(3);
  for (std::size_t s = 0; s < e.sites.size(); ++s) {
    const bool is_long = e.sites[s].condition == 1;
    for (std::size_t k = 0; k < 3; ++k)
      e.at(k, s, 0) = {4, 0.5 + ((k == 0) != is_long ? 0.1 : 0.0) + 0.01 * random.normal(), 0.01};
  }
  const auto first = [&](double endurance_s) {
    return name_of_first(e,
                         select(e, cave_figures(0, 0.4), {.conditions = {.endurance_s = endurance_s}}, "c"));
  };
  EXPECT_EQ(first(240), "steep");
  EXPECT_EQ(first(200), "steep");
  EXPECT_NE(first(480), "steep");
  EXPECT_NE(first(600), "steep");
}

TEST(Select, RefusesConditionsThatWereNeverFlown) {
  const Experience e = two_vehicles(8);
  const auto refusal = [&](const AskedConditions& asked) {
    const Selected s = select(e, cave_figures(0, 0.4), {.conditions = asked}, "cave");
    return s.refused ? s.reason : "named";
  };
  EXPECT_EQ(refusal({}), "named");
  EXPECT_EQ(refusal({.vehicle = "lidar_uav", .endurance_s = 500, .robots = 1}), "named");
  EXPECT_EQ(refusal({.vehicle = "balloon"}),
            "no flight of the vehicle balloon is known; those of camera_uav, lidar_uav are");
  EXPECT_EQ(refusal({.endurance_s = 1000}),
            "no flight of nearly 1000 s is known; those known last at most 300 to 300 s");
  EXPECT_EQ(refusal({.endurance_s = 90}),
            "no flight of nearly 90 s is known; those known last at most 300 to 300 s");
  EXPECT_EQ(refusal({.robots = 3}), "no flight of a team is known");
}

// Of another vehicle, what was found there is no proof.
TEST(Select, ACaveThatWasFlownDecidesUnderTheSameConditionsOnly) {
  Experience e = two_vehicles(8);
  e.caves[2].hash = "abc";
  const auto asked = [&](const AskedConditions& conditions) {
    return select(e, e.caves[2].figures, {.conditions = conditions}, "cave", "abc");
  };
  EXPECT_TRUE(asked({.vehicle = "camera_uav", .endurance_s = 310}).flown);
  EXPECT_FALSE(asked({.vehicle = "camera_uav", .endurance_s = 700}).flown);
  EXPECT_EQ(name_of_first(e, asked({.vehicle = "camera_uav", .endurance_s = 310})), "level");
}

TEST(Select, DepthsAreNotBeyondTheEndOfTheCave) {
  Experience e = experience(8, 0.3, 0.02, 3);
  for (std::size_t c = 0; c < e.caves.size(); ++c)
    for (std::size_t k = 0; k < 3; ++k) e.at(k, c, index_of(e, "depth_m")) = {4, 150, 5};
  CaveFigures cave = cave_figures(-0.9, 0.4);
  cave.length_m = 120;
  const Selected s = select(e, cave, {"depth_m"}, "cave");
  EXPECT_EQ(s.ranking.front().value, 120);
  EXPECT_LE(s.ranking.front().high, 120);
}

TEST(Fit, FindsTheFigureThatTells) {
  const Experience e = experience(24, 0.3, 0.02, 3);  // the slope, and the drop that goes with it
  const Fit f = fit(e, 0);
  double others = 0;
  for (std::size_t i = 0; i < figure_definitions().size(); ++i) {
    const std::string_view name = figure_definitions()[i].name;
    if (name != "verticality" && name != "drop") others += f.kernel.weights[i];
  }
  EXPECT_EQ(others, 0);
  EXPECT_LT(f.error, 0.3 * f.error_all_alike);
}

TEST(Fit, WhereNothingTellsMostlyAllCavesCountAlike) {
  int alike = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    alike += std::isinf(fit(experience(20, 0, 0.1, seed), 0).kernel.bandwidth);
  EXPECT_GE(alike, 10);
}

TEST(Select, RefusesWhatIsUnlikeAllThatWasFlownAndNamesWhy) {
  const Experience e = experience(12, 0.3, 0.02, 3);
  CaveFigures strange = cave_figures(0, 0.4);
  strange.width_m = 60;
  const Selected s = select(e, strange, {}, "cave");
  EXPECT_TRUE(s.refused);
  EXPECT_NE(s.reason.find("most unlike is its width: 60 m"), std::string::npos) << s.reason;
  CaveFigures huge = cave_figures(0, 0.4);
  huge.volume_m3 = 5e7;
  const Selected large = select(e, huge, {}, "cave");
  EXPECT_NE(large.reason.find("most unlike is its volume: 50,000,000 m³"), std::string::npos) << large.reason;
  EXPECT_GT(s.near.front().distance.value, s.limit);
}

TEST(Select, WhatDidBestOnAverageHasTheGreatestMeanShareOfTheBestOfEachCave) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Experience e = experience(12, 0.3, 0.2, seed);
    std::vector<double> share(e.contestants.size(), 0.0);
    for (std::size_t s = 0; s < e.sites.size(); ++s) {
      double most = 0;
      for (std::size_t k = 0; k < share.size(); ++k) most = std::max(most, e.at(k, s, 0).mean);
      for (std::size_t k = 0; k < share.size(); ++k) share[k] += e.at(k, s, 0).mean / most;
    }
    const auto best = best_on_average(e, 0, {});
    ASSERT_TRUE(best);
    EXPECT_EQ(best->contestant, std::max_element(share.begin(), share.end()) - share.begin());
    EXPECT_EQ(best->caves, 12u);
    EXPECT_EQ(best->vehicle, "");
  }
}

// As it was: a refusal for a camera named what did best with a LiDAR, and the first of the file where all
// were equal.
TEST(Select, WhatDidBestOnAverageIsThatOfTheVehicleAskedForAndNothingIfAllAreEqual) {
  Experience e = experience(6, 0.3, 0.02, 3);
  e.conditions = {karst::test::condition("lidar_uav"), karst::test::condition("camera_uav")};
  lay_out(e, all_sites(e));
  for (std::size_t s = 0; s < e.sites.size(); ++s)
    for (std::size_t k = 0; k < 3; ++k)
      e.at(k, s, 0) = {10, k == (e.sites[s].condition == 0 ? 1u : 2u) ? 0.5 : 0.4, 0.01};
  e.at(0, 0, 0) = e.at(1, 0, 0) = e.at(2, 0, 0) = {};
  AskedConditions asked;
  asked.vehicle = "lidar_uav";
  const auto lidar = best_on_average(e, 0, asked);
  ASSERT_TRUE(lidar);
  EXPECT_EQ(lidar->contestant, 1u);
  EXPECT_EQ(lidar->caves, 5u) << "in one nobody flew";
  EXPECT_EQ(
      best_on_average_in_words(e, *lidar, "coverage_auc").find("Of the flights of lidar_uav in 5 caves"), 0u);
  asked.vehicle = "camera_uav";
  EXPECT_EQ(best_on_average(e, 0, asked)->contestant, 2u);
  asked.vehicle = "another";
  EXPECT_EQ(best_on_average(e, 0, asked)->vehicle, "");
  for (std::size_t s = 0; s < e.sites.size(); ++s)
    for (std::size_t k = 0; k < 3; ++k) e.at(k, s, 0) = {10, 0.4, 0.01};
  EXPECT_FALSE(best_on_average(e, 0, asked));
}

TEST(Select, MissingFiguresAreLeftOut) {
  const Experience e = experience(20, 0.3, 0.02, 3);
  CaveFigures little;
  little.verticality = 0.7, little.drop_m = 80;
  const Selected s = select(e, little, {}, "cave");
  EXPECT_FALSE(s.refused) << s.reason;
  EXPECT_EQ(s.near.front().distance.shared, 2);
  EXPECT_EQ(name_of_first(e, s), "steep");
  // What says nothing about the slope cannot tell the two apart: the weights differ less.
  CaveFigures less;
  less.volume_m3 = 5000;
  const Selected t = select(e, less, {}, "cave");
  EXPECT_LT(t.near.front().weight, s.near.front().weight);
  EXPECT_LT(t.confidence, s.confidence);
}

TEST(Select, ContestantThatDidNotFlyNearbyIsNotNamed) {
  Experience e = experience(20, 0.3, 0.02, 3);
  // "steep" flew in level caves only, and never failed to be worst there; its absence elsewhere must not help
  // it.
  for (std::size_t c = 0; c < e.caves.size(); ++c)
    if (e.caves[c].figures.verticality > 0.4) e.at(0, c, 0) = {};
  const Selected s = select(e, cave_figures(0, 0.7), {}, "cave");
  EXPECT_NE(name_of_first(e, s), "steep");
}

TEST(Select, OfACaveThatWasFlownRestsOnWhatWasFoundThere) {
  Experience e = experience(20, 0.3, 0.02, 3);
  std::size_t steepest = 0;
  for (std::size_t c = 0; c < e.caves.size(); ++c)
    if (e.caves[c].figures.verticality > e.caves[steepest].figures.verticality) steepest = c;
  // Against all that caves like it say, "level" was best in the steepest.
  e.at(0, steepest, 0) = {4, 0.40, 0.02}, e.at(1, steepest, 0) = {4, 0.60, 0.02},
                    e.at(2, steepest, 0) = {1, 0.5, kUnknown};
  const CaveFigures cave = e.caves[steepest].figures;
  const Selected s = select(e, cave, {}, "cave");
  EXPECT_TRUE(s.flown);
  EXPECT_FALSE(s.refused);
  EXPECT_EQ(name_of_first(e, s), "level");
  EXPECT_NEAR(s.ranking.front().value, 0.60, 1e-12);
  // Student's quantile of 95 % with 3 degrees of freedom is 2.353.
  EXPECT_NEAR(s.ranking.front().high - 0.60, 2.353 * 0.02 / 2, 1e-4);
  EXPECT_TRUE(std::isnan(s.ranking[1].low));  // of a single flight
  EXPECT_EQ(s.near.front().cave, steepest);
  EXPECT_EQ(s.near.front().weight, 1);
  EXPECT_EQ(s.near[1].weight, 0);
  EXPECT_GT(s.confidence, 0.99);
  EXPECT_TRUE(s.reason.starts_with("level did best in ") &&
              s.reason.find("in this very cave, among 3 contestants.") != std::string::npos)
      << s.reason;
  // The mesh tells it, too: from another start, or described by other means.
  CaveFigures other = cave;
  other.volume_m3 *= 1.01;
  EXPECT_FALSE(select(e, other, {}, "cave", "abc").flown);
  e.caves[steepest].hash = "abc";
  EXPECT_TRUE(select(e, other, {}, "cave", "abc").flown);
  EXPECT_FALSE(select(e, other, {}, "cave").flown);
  // Few figures agree by chance; and one contestant alone tells nothing of the others.
  CaveFigures little;
  little.width_m = cave.width_m, little.volume_m3 = cave.volume_m3;
  EXPECT_FALSE(select(e, little, {}, "cave").flown);
  e.at(0, steepest, 0) = e.at(2, steepest, 0) = {};
  EXPECT_FALSE(select(e, cave, {}, "cave", "abc").flown);
}

TEST(Select, OfACaveThatWasFlownFewOthersAreEnough) {
  Experience e = experience(6, 0.3, 0.02, 3);
  while (e.caves.size() > 1) e = without_cave(e, 0);
  const Selected s = select(e, e.caves[0].figures, {}, "cave");
  EXPECT_TRUE(s.flown);
  EXPECT_EQ(s.ranking.size(), 3u);
  EXPECT_NEAR(s.ranking[0].value, std::max({e.at(0, 0, 0).mean, e.at(1, 0, 0).mean, e.at(2, 0, 0).mean}),
              1e-12);
}

// As it was: of too few caves the cave asked about was named.
TEST(Select, WhatTheResultsLackIsSaidOfThem) {
  Experience e = experience(6, 0.3, 0.02, 3);
  e.source = "runs/some";
  while (e.caves.size() > 3) e = without_cave(e, 0);
  const auto message = [&](auto action) -> std::string {
    try {
      action();
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message([&] {
              select(e, cave_figures(0, 0.4), {}, "new.info");
            }).find("runs/some: coverage_auc: is known of 3"),
            0u);
  EXPECT_EQ(message([&] { leave_one_out(e, {"coverage_acu"}, "karst select"); }).find("runs/some: "), 0u);
}

TEST(Select, BadInputIsAnError) {
  const Experience e = experience(8, 0.3, 0.02, 3);
  const auto message = [&](const Experience& known, const CaveFigures& cave,
                           const SelectOptions& o) -> std::string {
    try {
      select(known, cave, o, "here");
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const CaveFigures cave = cave_figures(0, 0.4);
  EXPECT_NE(message(e, {}, {}).find("here: nothing is known of the cave"), std::string::npos);
  EXPECT_NE(message(e, cave, {"coverage_acu"}).find("did you mean coverage_auc?"), std::string::npos);
  EXPECT_NE(message(e, cave, {"path_length_m"}).find("neither better nor worse"), std::string::npos);
  EXPECT_NE(message(e, cave, {"coverage"}).find("is known of 0 caves"), std::string::npos);
  Experience few = e;
  while (few.caves.size() > 3) few = without_cave(few, 0);
  EXPECT_NE(message(few, cave, {}).find("is known of 3 caves; 4 at least"), std::string::npos);
  CaveFigures other;
  other.tortuosity = 2;
  Experience blind = e;
  for (KnownCave& c : blind.caves) c.figures.tortuosity = kUnknown;
  EXPECT_NE(message(blind, other, {}).find("no cave that was flown has a figure"), std::string::npos);
}

TEST(LeaveOneOut, SelectingIsWorthItWhereCavesTell) {
  const LeaveOneOut l = leave_one_out(experience(24, 0.3, 0.03, 11), {"coverage_auc"}, "test");
  EXPECT_EQ(l.caves, 24u);
  EXPECT_GT(l.of(Rule::selected).within.mean, 0.75);
  EXPECT_GT(l.of(Rule::selected).within.mean, l.of(Rule::overall).within.mean + 0.2);
  EXPECT_GT(l.of(Rule::selected).within.mean, l.of(Rule::chance).within.mean + 0.2);
  EXPECT_LT(l.of(Rule::selected).lost.mean, l.of(Rule::overall).lost.mean);
  EXPECT_NEAR(l.of(Rule::chance).best.mean, 1.0 / 3, 1e-9);
}

TEST(LeaveOneOut, StartsInOneMeshAreOneCaveOfWhichNothingIsLeftOut) {
  Experience e = experience(8, 0.3, 0.03, 11);
  for (KnownCave& cave : e.caves) cave.hash = "one mesh";
  EXPECT_THROW(leave_one_out(e, {"coverage_auc"}, "test"), InputError);
  const Selected s = select(e, cave_figures(0, 0.4), {}, "new.info");
  EXPECT_TRUE(std::isnan(s.ranking.front().low)) << "one cave tells no interval";
}

TEST(LeaveOneOut, WhereCavesTellNothingItIsNearlyAsGoodAsTheOverallBest) {
  // One is better everywhere by 10 %, and noise is as large: selecting must not lose much by hunting it.
  double selected = 0, overall = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Experience e = experience(15, 0, 0.1, seed);
    for (std::size_t c = 0; c < e.caves.size(); ++c) e.at(2, c, 0).mean *= 1.1;
    const LeaveOneOut l = leave_one_out(e, {"coverage_auc"}, "test");
    selected += l.of(Rule::selected).lost.mean / 10, overall += l.of(Rule::overall).lost.mean / 10;
  }
  EXPECT_LT(selected, overall + 0.02);
}

TEST(LeaveOneOut, ByHandInFiveCaves) {
  // Five caves that are all alike; "a" is best in four, "b" in the fifth. Left out, the others name "a" every
  // time.
  Experience e;
  e.contestants = {{"a", "a", "1", {}}, {"b", "b", "1", {}}};
  e.conditions = {karst::test::condition()};
  for (int c = 0; c < 5; ++c) e.caves.push_back({"c" + std::to_string(c), cave_figures(0.01 * c, 0.4)});
  lay_out(e, all_sites(e));
  for (std::size_t c = 0; c < 5; ++c)
    e.at(0, c, 0) = {3, 0.5, 0.0}, e.at(1, c, 0) = {3, c == 4 ? 0.55 : 0.48, 0.0};
  const LeaveOneOut l = leave_one_out(e, {"coverage_auc"}, "test");
  EXPECT_NEAR(l.of(Rule::selected).best.mean, 0.8, 1e-12);
  EXPECT_NEAR(l.of(Rule::selected).within.mean, 0.8, 1e-12);
  EXPECT_NEAR(l.of(Rule::selected).lost.mean, 0.05 / 0.55 / 5, 1e-12);
  EXPECT_NEAR(l.of(Rule::chance).best.mean, 0.5, 1e-12);
  EXPECT_NEAR(l.of(Rule::chance).within.mean, (4 * 1.0 + 0.5) / 5, 1e-12);  // 0.48 is within 5 % of 0.5
  try {
    leave_one_out(without_cave(e, 0), {"coverage_auc"}, "test");  // three others are too few
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("is known of 4 caves; 5 at least are needed"), std::string::npos)
        << error.what();
  }
}

// Two vehicles, two goals, by hand: which rule sees what.
TEST(LeaveOneOut, RulesSeeWhatTheyAreToldOnly) {
  Experience e = two_vehicles(6);
  const std::size_t depth = index_of(e, "depth_m");
  for (std::size_t s = 0; s < e.sites.size(); ++s)
    for (std::size_t k = 0; k < 3; ++k) e.at(k, s, depth) = {4, k == 2 ? 100.0 : 50.0, 1};  // "both" is best
  const LeaveOneOut l = leave_one_out(e, {"coverage_auc", "depth_m"}, "test");
  EXPECT_EQ(l.caves, 6u);
  EXPECT_EQ(l.choices.size(), 24u);
  EXPECT_NEAR(l.of(Rule::selected).lost.mean, 0, 1e-12);
  EXPECT_NEAR(l.of(Rule::conditions).lost.mean, 0, 1e-12);
  // "both" loses 1/6 of the coverage and none of the depth; the best of a vehicle half of the depth.
  EXPECT_NEAR(l.of(Rule::overall).lost.mean, 0.5 / 6, 0.02);
  EXPECT_NEAR(l.of(Rule::vehicle).lost.mean, 0.5 / 6, 0.02);
  EXPECT_LE(l.of(Rule::goal).lost.mean, 0.5 / 3);
  EXPECT_NEAR(l.of(Rule::chance).lost.mean, (0.5 * 2 / 3 + (1 / 3.0 + 1 / 6.0) / 3) / 2, 0.02);
  EXPECT_NEAR(l.lost_ratio[static_cast<std::size_t>(Rule::overall)].mean, 0, 1e-9);
  EXPECT_GE(l.of(Rule::overall).lost.high, l.of(Rule::overall).lost.mean);
}

// Other starts in a cave would foretell what happens there.
TEST(LeaveOneOut, TheSameRockIsOneCave) {
  Experience e = experience(12, 0.3, 0.02, 3);
  for (std::size_t c = 0; c < e.caves.size(); ++c) e.caves[c].hash = "mesh" + std::to_string(c / 2);
  EXPECT_TRUE(same_rock(e.caves[0], e.caves[1]));
  EXPECT_FALSE(same_rock(e.caves[1], e.caves[2]));
  const Values v = values_of(e, 0);
  Kernel near = fit(e, 0).kernel;
  near.weights.assign(figure_definitions().size(), 1.0);
  near.bandwidth = 0.35;
  e.caves[1].figures = e.caves[0].figures;
  const double before = left_out_residuals(e, v, levels(v), near)[0];
  e.at(0, 1, 0).mean += 0.2;  // of the same rock: must not matter
  const Values w = values_of(e, 0);
  std::vector<double> level = levels(v);
  EXPECT_EQ(left_out_residuals(e, w, level, near)[0], before);
}

TEST(Goals, StandForFigures) {
  EXPECT_EQ(metric_for("deepest", "test"), "depth_m");
  EXPECT_EQ(metric_for("restricted_t90_s", "test"), "restricted_t90_s");
  EXPECT_EQ(goal_of("surface_imaged"), "walls");
  for (const Goal& g : goals())
    EXPECT_NE(std::find(learned_metrics().begin(), learned_metrics().end(), g.metric),
              learned_metrics().end())
        << g.name;
  try {
    metric_for("deepst", "test");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean deepest?"), std::string::npos) << error.what();
  }
}

TEST(Condition, FollowsFromTheSettings) {
  Condition c;
  c.horizon_s = 500;
  c.mission = {{"simulator.vehicle", "lidar_uav"},
               {"simulator.battery_minutes", "8 min"},
               {"simulator.lidar.unit", "os0_32"},
               {"team.robots", "3"}};
  complete(c, "3600 s", "test");
  EXPECT_EQ(c.endurance_s, 480);
  EXPECT_EQ(c.robots, 3);
  EXPECT_EQ(c.name, "lidar_uav_os0_32_480s_team3");
  EXPECT_EQ(in_words(c), "lidar_uav (os0_32), 480 s, a team of 3");
  Condition shorter = c;
  shorter.endurance_s = 0;
  complete(shorter, "300 s", "test");
  EXPECT_EQ(shorter.endurance_s, 300);
  EXPECT_THROW(complete(shorter = {.horizon_s = 1}, "soon", "test"), InputError);
}

karst::campaign::CampaignResults results() {
  karst::campaign::CampaignResults r;
  r.name = "test";
  r.horizon_s = 300;
  r.profile = "campaign";
  r.shared = {{"vehicle", "lidar_uav"}};
  r.contestants = {
      {"near", "nearest_frontier", "1.0.0", R"({"max_distance":"30 m","goals":8,"keep":true})", "{}"},
      {"windy", "nearest_frontier", "1.0.0", "{}", R"({"simulator.gust":"2 m/s"})"}};
  r.caves = {{"a", "a.info", "", to_json(cave_figures(0, 0.1)), ""},
             {"b", "b.info", "", "", ""},
             {"c", "c.info", "", to_json(cave_figures(1, 0.4)), ""}};
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t c = 0; c < 2; ++c)
      for (int seed = 1; seed <= 3; ++seed) {
        karst::campaign::TrialResult t;
        t.contestant = k, t.cave = c, t.seed = seed;
        t.figures.assign(karst::evaluation::metric_definitions().size(), std::nan(""));
        t.figures[static_cast<std::size_t>(karst::evaluation::metric_index("coverage"))] = 0.1 * seed;
        t.failed = seed == 3;
        if (t.failed) t.figures.assign(t.figures.size(), std::nan(""));
        r.trials.push_back(t);
      }
  return r;
}

TEST(Experience, OfACampaignHoldsMeansAndCountsFailures) {
  const Experience e = learn(results(), "store");
  ASSERT_EQ(e.caves.size(), 1u);  // b was not described, c not flown
  ASSERT_EQ(e.contestants.size(), 1u);
  EXPECT_EQ(e.contestants[0].parameters.get<std::string>("max_distance"), "30 m");
  EXPECT_EQ(e.contestants[0].parameters.get<std::string>("goals"), "8");
  const auto m =
      static_cast<std::size_t>(std::find(e.metrics.begin(), e.metrics.end(), "coverage") - e.metrics.begin());
  EXPECT_EQ(e.at(0, 0, m).flights, 3);
  EXPECT_NEAR(e.at(0, 0, m).mean, 0.1, 1e-12);  // 0.1, 0.2, and nothing found by the one that failed
  EXPECT_NEAR(e.at(0, 0, m).deviation, 0.1, 1e-12);
  const auto t90 = static_cast<std::size_t>(
      std::find(e.metrics.begin(), e.metrics.end(), "restricted_t90_s") - e.metrics.begin());
  EXPECT_EQ(e.at(0, 0, t90).mean, 300);
  EXPECT_EQ(e.conditions[0].horizon_s, 300);
  EXPECT_EQ(e.conditions[0].profile, "campaign");
  EXPECT_EQ(e.conditions[0].mission, results().shared);
}

TEST(Experience, StoreWithoutDescribedCavesIsAnError) {
  karst::campaign::CampaignResults r = results();
  for (auto& c : r.caves) c.description.clear();
  EXPECT_THROW(learn(r, "store"), InputError);
  r = results();
  r.trials.clear();
  EXPECT_THROW(learn(r, "store"), InputError);
  r = results();
  r.caves[0].description = "{\"volume\": \"large\"}";
  EXPECT_THROW(learn(r, "store"), InputError);
  r = results();
  r.profile.clear();
  EXPECT_THROW(learn(r, "store"), InputError);
}

std::string written(const std::string& name, const std::string& text) {
  // A folder of each test's own: they run side by side.
  const std::filesystem::path dir = std::filesystem::path(testing::TempDir()) / "experience_files" /
                                    testing::UnitTest::GetInstance()->current_test_info()->name();
  std::filesystem::create_directories(dir);
  std::ofstream(dir / name) << text;
  return (dir / name).string();
}

/// An empty folder but for box.ply, a cave of 12 x 4 x 3 m.
std::filesystem::path folder_with_box(const std::string& name) {
  const std::filesystem::path dir = std::filesystem::path(testing::TempDir()) / name;
  std::filesystem::remove_all(dir);
  std::filesystem::create_directories(dir);
  std::set<std::array<int, 3>> cells;
  karst::test::fill(cells, {0, 0, 0}, {12, 4, 3});
  karst::cave::write_mesh((dir / "box.ply").string(),
                          karst::test::lattice_mesh(cells, 1.0, {0.03, 0.03, 0.03}));
  return dir;
}

// As it was: given a campaign's folder, descriptions were not kept.
TEST(Experience, CavesOfAStoreAreDescribedOnceAndThoseWhoseFileIsGoneAreLeftOut) {
  const std::filesystem::path dir = folder_with_box("undescribed_store");
  karst::campaign::StoreHead head;
  head.name = "test";
  head.definition = R"(profile campaign
contestant { name windy settings "{\"simulator.gust\":\"2 m/s\"}" mission { simulator { gust 2 } } }
contestant { name near settings "{}"
  mission { vehicle lidar_uav  policy { name nearest_frontier }
            mission { max_flight_time "300 s"  landing_speed "0.4 m/s" } } }
)";
  head.horizon_s = 300;
  head.contestants = {{"near", "nearest_frontier", "1.0.0", "{}", "{}"}};
  head.caves = {{"box", (dir / "box.ply").string(), "2 2 1.5", "", ""},
                {"gone", (dir / "gone.ply").string(), "0 0 1", "", ""}};
  head.seeds = {1};
  {
    auto store = karst::campaign::Store::create(dir / "campaign.sqlite", head);
    for (std::size_t c = 0; c < 2; ++c) {
      karst::campaign::StoredTrial t;
      t.result.cave = c, t.result.seed = 1, t.result.outcome = "landed";
      t.result.figures.assign(karst::evaluation::metric_definitions().size(), 0.5);
      store.add(t);
    }
  }
  std::vector<std::string> told;
  const auto tell = [&](const std::string& s) { told.push_back(s); };
  const Experience e = load_experience({dir.string()}, tell);
  ASSERT_EQ(e.caves.size(), 1u);
  EXPECT_NEAR(e.caves[0].figures.width_m, 3, 0.1);
  const std::vector<std::pair<std::string, std::string>> shared{{"vehicle", "lidar_uav"},
                                                                {"mission.landing_speed", "0.4 m/s"}};
  EXPECT_EQ(e.conditions[0].mission, shared);
  ASSERT_EQ(told.size(), 3u);
  EXPECT_EQ(told[0], "describing box");
  EXPECT_NE(told[2].find("gone.ply"), std::string::npos) << told[2];
  told.clear();
  const Experience again = load_experience({(dir / "campaign.sqlite").string()}, tell);
  EXPECT_EQ(to_info(again), to_info(e));
  EXPECT_EQ(told.size(), 2u);  // the one that is gone, again
}

TEST(Experience, CaveWhoseMeshIsAnotherThanTheOneFlownIsLeftOut) {
  const std::filesystem::path dir = folder_with_box("changed_cave_store");
  karst::campaign::StoreHead head;
  head.name = "test";
  head.definition = "profile campaign\n";
  head.horizon_s = 300;
  head.contestants = {{"near", "nearest_frontier", "1.0.0", "{}", "{}"}};
  head.caves = {{"box", (dir / "box.ply").string(), "2 2 1.5", "", std::string(64, 'a')}};
  head.seeds = {1};
  karst::campaign::Store::create(dir / "campaign.sqlite", head);
  std::vector<std::string> told;
  EXPECT_THROW(load_experience({dir.string()}, [&](const std::string& s) { told.push_back(s); }), InputError);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_NE(told[1].find("box.ply: is not the mesh any more that was flown"), std::string::npos) << told[1];
}

TEST(Experience, SurvivesItsFile) {
  Experience e = experience(6, 0.3, 0.1, 2);
  e.caves[2].name = "a cave; with \"quotes\"";
  e.caves[3].figures.loops = kUnknown;
  e.caves[1].hash = std::string(64, 'a');
  e.conditions[0].horizon_s = 1234.56789;
  e.at(1, 2, 3) = {1, 0.25, kUnknown};
  const std::string text = to_info(e);
  const Experience f = read_experience(written("whole.info", text));
  EXPECT_EQ(to_info(f), text);
  EXPECT_EQ(f.caves[2].name, e.caves[2].name);
  EXPECT_TRUE(std::isnan(f.caves[3].figures.loops));
  EXPECT_EQ(f.caves[1].hash, e.caves[1].hash);
  EXPECT_EQ(f.conditions[0].horizon_s, 1234.56789);
  EXPECT_EQ(difference(e.conditions[0], f.conditions[0]), "");
  EXPECT_EQ(f.at(1, 2, 3).mean, 0.25);
  EXPECT_TRUE(std::isnan(f.at(1, 2, 3).deviation));
  EXPECT_EQ(f.at(0, 0, 1).flights, 0);
}

TEST(Experience, BadFilesAreErrors) {
  const std::string flown =
                        "schema karst.experience/3\nflown { profile campaign }\n"
                        "condition { name q horizon \"300 s\" endurance \"300 s\" }\n",
                    head = flown + "cave { name a }\ncontestant { name k policy p }\n";
  const auto message = [&](const std::string& text) -> std::string {
    try {
      read_experience(written("bad.info", text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(head), "accepted");
  EXPECT_NE(message("width 4\n").find("expected karst.experience/3"), std::string::npos);
  EXPECT_NE(message(flown).find("no cave or no contestant"), std::string::npos);
  EXPECT_NE(message(head + "cave { name a }\n").find("a: is there twice"), std::string::npos);
  EXPECT_NE(message(head + "cavee { name b }\n").find("did you mean cave?"), std::string::npos);
  EXPECT_NE(message(head + "cave { name b figures { widht 4 } }\n").find("did you mean width?"),
            std::string::npos);
  EXPECT_NE(message(head + "contestant { name l }\n").find("lacks its policy"), std::string::npos);
  EXPECT_NE(
      message(head + "result { contestant k cave z condition q coverage \"1 1\" }\n").find("no such cave: z"),
      std::string::npos);
  EXPECT_NE(message(head + "result { contestant k cave a condition q cover \"1 1\" }\n")
                .find("result.cover: no such figure"),
            std::string::npos);
  for (const char* bad : {"many", "0.5", "0.5 0", "0.5 -2", "nan 3", "0.5 3 -1", "0.5 3 0.1 7", "0.5 3 x"})
    EXPECT_NE(message(head + "result { contestant k cave a condition q coverage \"" + bad + "\" }\n")
                  .find("expected \"mean flights"),
              std::string::npos)
        << bad;
}

std::string message_of(const std::string& text) {
  try {
    read_experience(written("bad.info", text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// As it was: a file told neither horizon nor profile.
TEST(Experience, FileThatDoesNotTellHowItWasFlownSaysHowToMakeANewOne) {
  for (const char* schema : {"karst.experience/1", "karst.experience/2"}) {
    const std::string old = std::string("schema ") + schema +
                            "\nflown { horizon \"300 s\" profile campaign }\ncave { name a }\n"
                            "contestant { name k policy p }\n";
    EXPECT_NE(message_of(old).find("karst.experience/3 does: make it anew from the campaign: karst select "
                                   "--learn STORE --out"),
              std::string::npos)
        << message_of(old);
  }
  const std::string rest = "cave { name a }\ncontestant { name k policy p }\n",
                    head = "schema karst.experience/3\n" + rest,
                    flown = head + "flown { profile campaign }\n";
  EXPECT_NE(message_of(head).find("flown: expected one such block"), std::string::npos);
  EXPECT_NE(message_of(flown).find("holds no condition"), std::string::npos);
  EXPECT_NE(message_of(head + "flown { }\n").find("flown: lacks its profile"), std::string::npos);
  EXPECT_NE(message_of(head + "flown { horizon \"5 min\" }\n").find("flown.horizon: no such key"),
            std::string::npos);
  const auto condition = [&](const std::string& keys) {
    return message_of(flown + "condition { " + keys + " }\n");
  };
  EXPECT_EQ(condition("name q horizon \"5 min\" endurance \"5 min\" robots 3 vehicle v sensors s"),
            "accepted");
  EXPECT_NE(condition("horizon \"5 min\"").find("condition: lacks its name"), std::string::npos);
  EXPECT_NE(condition("name q endurance \"5 min\"").find("condition q: lacks its horizon"),
            std::string::npos);
  EXPECT_NE(condition("name q horizon \"5 min\"").find("condition q: lacks its endurance"),
            std::string::npos);
  EXPECT_NE(condition("name q horizn 300").find("did you mean horizon?"), std::string::npos);
  for (const char* bad : {"robots 0", "robots -2", "robots many", "robots 1.5"})
    EXPECT_NE(condition(std::string("name q horizon \"5 min\" endurance \"5 min\" ") + bad)
                  .find("condition q: robots: expected"),
              std::string::npos)
        << bad;
  for (const char* bad : {"-300 s", "0", "nan", "3 m"})
    EXPECT_NE(condition(std::string("name q horizon \"") + bad + "\"").find("condition q: horizon: expected"),
              std::string::npos)
        << bad;
  const std::string both = "condition { name q horizon \"5 min\" endurance \"5 min\" vehicle v }\n";
  EXPECT_NE(message_of(flown + both + both).find("q: is there twice"), std::string::npos);
  EXPECT_NE(message_of(flown + both + "condition { name r horizon 300 endurance 300 vehicle v }\n")
                .find("r: is the same condition as q"),
            std::string::npos)
      << message_of(flown + both + "condition { name r horizon 300 endurance 300 vehicle v }\n");
  EXPECT_NE(message_of(flown + both + "result { contestant k cave a coverage \"1 1\" }\n")
                .find("result of k in a: lacks its condition"),
            std::string::npos);
  EXPECT_NE(message_of(flown + both + "result { contestant k cave a condition z coverage \"1 1\" }\n")
                .find("no such condition: z"),
            std::string::npos);
}

// As it was: a coverage of 7 was believed.
TEST(Experience, ImpossibleFiguresAreErrors) {
  const std::string head =
      "schema karst.experience/3\nflown { profile campaign }\n"
      "condition { name q horizon \"300 s\" endurance \"300 s\" }\n"
      "cave { name a }\ncontestant { name k policy p }\n";
  const auto result = [&](const std::string& figure) {
    return message_of(head + "result { contestant k cave a condition q " + figure + " }\n");
  };
  for (const char* good : {"coverage \"1 1\"", "coverage \"0 2 0\"", "coverage \"0.5 2 0.707107\"",
                           "restricted_t90_s \"300 3 0\"", "path_length_m \"900 3 1200\""})
    EXPECT_EQ(result(good), "accepted") << good;
  for (const char* bad : {"coverage \"7 3\"", "coverage_auc \"-0.1 3\"", "completed \"1.01 3\"",
                          "restricted_t90_s \"301 3\"", "path_length_m \"-1 3\"", "contacts \"-2 3\""})
    EXPECT_NE(
        result(bad).find("k in a: " + std::string(bad).substr(0, std::string(bad).find(' ')) + ": the mean"),
        std::string::npos)
        << result(bad);
  EXPECT_NE(result("coverage \"0.5 1 0.1\"").find("a single flight has no deviation"), std::string::npos);
  EXPECT_NE(result("coverage \"0.5 3 0.8\"").find("the deviation 0.8 is impossible"), std::string::npos);
  for (const char* bad : {"inf 3", "nan 3", "0.5 0", "0.5 3 nan", "0.5 3 inf"})
    EXPECT_NE(result("coverage \"" + std::string(bad) + "\"").find("expected \"mean flights"),
              std::string::npos)
        << bad;
  for (const char* bad : {"width \"-3 m\"", "width nan", "volume 0", "verticality 2", "loops -1"})
    EXPECT_NE(message_of(head + "cave { name b figures { " + bad + " } }\n").find("cave b: "),
              std::string::npos)
        << bad;
  EXPECT_NE(message_of(head + "cave { name b hash xyz }\n").find("cave b: hash: expected"),
            std::string::npos);
}

TEST(Experience, OfTwoCampaignsIsOneUnlessTheyContradict) {
  const Experience a = experience(5, 0.3, 0.1, 2);
  Experience b = experience(4, 0.3, 0.1, 3);
  for (KnownCave& c : b.caves) c.name += "b";
  const Experience both = merged(a, b, "b");
  EXPECT_EQ(both.caves.size(), 9u);
  EXPECT_EQ(both.contestants.size(), 3u);
  EXPECT_EQ(both.at(1, 4, 0).mean, a.at(1, 4, 0).mean);
  EXPECT_EQ(both.at(1, 5, 0).mean, b.at(1, 0, 0).mean);
  EXPECT_THROW(merged(a, a, "again"), InputError);  // the same flights twice
  Experience other = b;
  other.caves[0].name = "cave0";
  EXPECT_THROW(merged(a, other, "other"), InputError);
  other = b;
  other.contestants[0].parameters.put("reach", "5 m");
  EXPECT_THROW(merged(a, other, "other"), InputError);
}

// As it was: flights of 300 s and of 60 s were averaged.
TEST(Experience, FlownOtherwiseIsNotMixed) {
  const Experience a = experience(5, 0.3, 0.1, 2);
  Experience b = experience(4, 0.3, 0.1, 3);
  for (KnownCave& c : b.caves) c.name += "b";
  const auto message = [&](auto change) -> std::string {
    Experience other = b;
    change(other);
    try {
      merged(a, other, "other");
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message([](Experience&) {}), "accepted");
  EXPECT_NE(message([](Experience& e) {
              e.conditions[0].horizon_s = 60;
            }).find("horizon 60.0 s here, 300.0 s there"),
            std::string::npos);
  EXPECT_NE(message([](Experience& e) {
              e.conditions[0].profile = "full";
            }).find("profile full here, campaign there"),
            std::string::npos);
  EXPECT_NE(message([](Experience& e) {
              e.conditions[0].mission[1].second = "1 m/s";
            }).find("motion.max_speed 1 m/s here, 1.5 m/s there"),
            std::string::npos);
  EXPECT_NE(
      message([](Experience& e) { e.contestants[1].version = "1.1.0"; })
          .find("level: is another contestant than the one of the same name in other results: version 1.1.0 "
                "here, 1.0.0 there"),
      std::string::npos);
  EXPECT_NE(message([](Experience& e) {
              e.contestants[0].parameters.put("reach", "5 m");
            }).find("parameters reach=5 m here, reach=3 m there"),
            std::string::npos);
  // Other vehicles and times are other conditions: they stand side by side.
  Experience camera = a;
  camera.conditions[0] = karst::test::condition("camera_uav", 480);
  const Experience both = merged(a, camera, "other");
  EXPECT_EQ(both.conditions.size(), 2u);
  EXPECT_EQ(both.caves.size(), 5u);
  EXPECT_EQ(both.sites.size(), 10u);
  EXPECT_EQ(both.at(1, 7, 0).mean, a.at(1, 2, 0).mean);
  EXPECT_EQ(to_info(read_experience(written("both.info", to_info(both)))), to_info(both));
  camera.conditions[0].mission[1].second = "1 m/s";
  EXPECT_THROW(merged(a, camera, "other"), InputError);
  // A setting that one of them does not have yet.
  EXPECT_EQ(message([](Experience& e) { e.conditions[0].mission.emplace_back("simulator.haze", "0"); }),
            "accepted");
}

TEST(Preset, SurvivesItsFileAndRefusesAnythingElse) {
  PolicyPreset p{"unknown_ratio", {}};
  p.parameters.put("ratio_worth", "7.2 m");
  const PolicyPreset q = read_preset(written("preset.info", to_info(p, "made by hand\non a day")));
  EXPECT_EQ(q.policy, p.policy);
  EXPECT_EQ(q.parameters, p.parameters);
  for (const char* bad : {"", "seed 3\n", "policy { parameters { a 1 } }\n", "policy x\n",
                          "policy { name a }\npolicy { name b }\n", "policy { name a name b }\n",
                          "policy { name a version 3 }\n", "policy { name a }\nmap { resolution 0.1 }\n"})
    EXPECT_THROW(read_preset(written("bad_preset.info", bad)), InputError) << bad;
}

}  // namespace
