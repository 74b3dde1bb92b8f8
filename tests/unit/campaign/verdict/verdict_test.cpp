// Verdicts on campaigns whose truth is known.
#include "sdk/campaign/verdict/verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core_stack/common/error.h"
#include "sdk/campaign/verdict/figure_words.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "tests/unit/campaign/verdict/drawn_campaign.h"

namespace karst::campaign {
namespace {

using evaluation::metric_index;
using test::CoverageModel;
using test::drawn_campaign;
using test::figure;
using test::Figures;

/// Contestant i covers `factors[i]` times as much as the model says.
CampaignResults coverage_campaign(std::uint64_t seed, const std::vector<double>& factors, std::size_t caves,
                                  std::int64_t seeds) {
  const CoverageModel model(seed);
  return drawn_campaign(factors.size(), caves, seeds, [&](std::size_t c, std::size_t cave, std::int64_t s) {
    return Figures{{"coverage_auc", model(c, cave, s, factors[c])}};
  });
}

const Comparison& primary(const Verdicts& v, std::size_t a = 0, std::size_t b = 1) {
  return *v.find(a, b, v.metric);
}

TEST(Verdict, ComparesTrialsOfTheSameCaveAndSeedAndWeighsCavesTheSame) {
  // Cave 1: differences 1, 3; cave 2: -10, 6, 10.
  auto results = drawn_campaign(2, 2, 3, [](std::size_t c, std::size_t cave, std::int64_t seed) {
    const double b = 100 * static_cast<double>(seed);
    const double differences[2][3] = {{1, 3, 99}, {-10, 6, 10}};
    return Figures{{"explored_volume_m3", c == 0 ? b + differences[cave][seed - 1] : b}};
  });
  std::erase_if(results.trials, [](auto& t) { return t.contestant == 1 && t.cave == 0 && t.seed == 3; });
  const Verdicts v = compare_all(results);
  const Comparison& c = *v.find(1, 0, metric_index("explored_volume_m3"));
  EXPECT_EQ(c.a, 0u);
  EXPECT_EQ(c.pairs, 5u);
  EXPECT_EQ(c.unpaired, 1u);
  EXPECT_EQ(c.caves, 2u);
  EXPECT_DOUBLE_EQ(c.difference, (2.0 + 2.0) / 2);
  EXPECT_DOUBLE_EQ(c.mean_a - c.mean_b, c.difference);
  ASSERT_EQ(c.per_cave.size(), 2u);
  EXPECT_EQ(c.per_cave[0].pairs, 2u);
  EXPECT_DOUBLE_EQ(c.per_cave[1].difference, 2);
  EXPECT_EQ(c.pair_seed, (std::vector<std::int64_t>{1, 2, 1, 2, 3}));
  EXPECT_EQ(c.test.rank_sum_positive, 1 + 2 + 3 + 4.5);  // |d|: 1 3 6 10 10
  EXPECT_EQ(c.test.rank_sum_negative, 4.5);
}

TEST(Verdict, FewerPairsThanTheLeastNeverShowADifferenceThatIsAsPlainAsCanBe) {
  EXPECT_EQ(min_pairs(1, 0.05), 0u);
  EXPECT_EQ(min_pairs(2, 0.05), 6u);
  for (const std::size_t contestants : {2u, 3u, 4u, 7u}) {
    const std::size_t least = min_pairs(contestants, 0.05);
    const auto p_of = [&](std::size_t pairs) {  // all to one side, no two equal
      std::vector<double> differences;
      for (std::size_t i = 1; i <= pairs; ++i) differences.push_back(static_cast<double>(i));
      return evaluation::signed_rank(differences).p * static_cast<double>(contestants * (contestants - 1)) /
             2;
    };
    EXPECT_LT(p_of(least), 0.05);
    EXPECT_GE(p_of(least - 1), 0.05);
  }
  const auto shown = [](std::int64_t seeds) {
    return primary(compare_all(drawn_campaign(
                       2, 1, seeds,
                       [](std::size_t c, std::size_t, std::int64_t s) {
                         return Figures{{"coverage_auc", 0.3 + static_cast<double>(c) *
                                                                   (0.3 + 0.01 * static_cast<double>(s))}};
                       })))
        .shown;
  };
  EXPECT_EQ(shown(5), Shown::no_difference);
  EXPECT_EQ(shown(6), Shown::b_better);
}

TEST(Verdict, DoesNotCareForTheOrderOfTrials) {
  auto results = coverage_campaign(3, {1.05, 1, 1.1}, 3, 4);
  const Verdicts one = compare_all(results);
  std::reverse(results.trials.begin(), results.trials.end());
  const Verdicts other = compare_all(results);
  ASSERT_EQ(one.comparisons.size(), other.comparisons.size());
  for (std::size_t i = 0; i < one.comparisons.size(); ++i)
    EXPECT_EQ(one.comparisons[i].sentence, other.comparisons[i].sentence);
  EXPECT_EQ(one.sentence, other.sentence);
}

TEST(Verdict, SaysWhichIsBetterByHowMuchAndHowSure) {
  const Verdicts v = compare_all(coverage_campaign(1, {1.0, 1.1}, 6, 10));
  EXPECT_EQ(primary(v).shown, Shown::b_better);
  EXPECT_TRUE(primary(v).interval.excludes(0));
  EXPECT_LT(primary(v).p_corrected, 0.001);
  EXPECT_LT(primary(v).rank_biserial, -0.8);
  EXPECT_EQ(v.sentence.rfind("B covers more, averaged over the flight, than A: ", 0), 0u) << v.sentence;
  EXPECT_NE(v.sentence.find(" points (95 % CI "), std::string::npos) << v.sentence;
  EXPECT_NE(v.sentence.find("6 caves x 10 seeds, p < 0.001)"), std::string::npos) << v.sentence;
}

// "B less by 0.37 points (95 % CI -1.18 to 1.35)" had an interval of the other sign than the tables.
TEST(Verdict, WithoutAShownDifferenceGivesDifferenceAndIntervalAsTheTablesDo) {
  const auto results = drawn_campaign(2, 1, 8, [](std::size_t k, std::size_t, std::int64_t seed) {
    return Figures{{"coverage_auc", 0.5 + (k == 0 ? (seed % 2 ? -0.03 : 0.02) : 0)}};
  });
  const Comparison c = primary(compare_all(results, {.simulations = 0}));
  ASSERT_EQ(c.shown, Shown::no_difference);
  ASSERT_NEAR(c.difference, -0.005, 1e-9);
  ASSERT_GT(-c.interval.low, c.interval.high);
  const int decimals = decimals_for(100 * (c.interval.high - c.interval.low) / 5, 2);
  const std::string expected =
      "in coverage averaged over the flight: A minus B: " + fixed_text(-0.5, decimals) + " points (95 % CI " +
      fixed_text(100 * c.interval.low, decimals) + " to " + fixed_text(100 * c.interval.high, decimals) +
      " points; ";
  EXPECT_NE(c.sentence.find(expected), std::string::npos) << c.sentence << "\nexpected " << expected;
}

TEST(Verdict, SaysSoonerOfShorterTimes) {
  const auto results = drawn_campaign(2, 3, 8, [](std::size_t c, std::size_t cave, std::int64_t seed) {
    return Figures{{"restricted_t90_s", 200.0 + 10.0 * double(cave) + double(seed * 7 % 5) +
                                            (c == 0 ? 0 : 30 + double(seed % 3))}};
  });
  const Verdicts v = compare_all(results, {.metric = "restricted_t90_s"});
  EXPECT_EQ(v.sentence.rfind("A covers 90 % sooner than B: 31", 0), 0u) << v.sentence;
  EXPECT_NE(v.sentence.find(" s (95 % CI "), std::string::npos) << v.sentence;
}

TEST(Verdict, SaysWhyNoDifferenceIsShownWhereTheIntervalAloneDoesNotTell) {
  // Six pairs: p is 2/64 at least, and 6/64 for three contestants.
  const Verdicts few = compare_all(coverage_campaign(1, {1, 1.3, 1.6}, 3, 2));
  EXPECT_EQ(primary(few).shown, Shown::no_difference);
  EXPECT_NE(
      primary(few).sentence.find(
          "; 6 pairs cannot show any: p would have to be below 0.05, and of so few it is 0.094 at least"),
      std::string::npos)
      << primary(few).sentence;
  // A is far ahead in one cave, and a little behind in two.
  const auto by_cave = drawn_campaign(2, 3, 10, [](std::size_t k, std::size_t c, std::int64_t seed) {
    const double ahead = k == 1 ? 0 : c == 0 ? 0.3 : -0.01;
    return Figures{{"coverage_auc", 0.5 + ahead + 0.001 * double(seed % 3)}};
  });
  const Verdicts v = compare_all(by_cave);
  EXPECT_EQ(primary(v).shown, Shown::no_difference);
  EXPECT_GT(primary(v).interval.low, 0);
  EXPECT_NE(
      v.sentence.find("; the means differ, but pairs fall either way: their test, which decides, gives no p "
                      "below 0.05, and who is ahead depends on the cave"),
      std::string::npos)
      << v.sentence;
}

TEST(Verdict, SaysWhatCorrectionDoesToAPairThatWouldShowADifferenceByItself) {
  // Signed ranks 1, 2, 3, -4, 5 ... 9: 7 of 512 patterns have a sum of 4 or less to a side, so p = 14 / 512.
  // C lies halfway between A and B, so the other two pairs have the same p, and Holm's correction makes each
  // 42 / 512.
  const auto results = drawn_campaign(3, 1, 9, [](std::size_t k, std::size_t, std::int64_t seed) {
    const double ahead = (seed == 4 ? -0.01 : 0.01) * double(seed);
    return Figures{{"coverage_auc", 0.5 + (k == 0 ? ahead : k == 2 ? ahead / 2 : 0)}};
  });
  const Comparison c = primary(compare_all(results, {.simulations = 0}));
  ASSERT_EQ(c.shown, Shown::no_difference);
  ASSERT_TRUE(c.interval.excludes(0));
  EXPECT_NE(c.sentence.find("p = 0.082 after correction for 3 comparisons)"), std::string::npos)
      << c.sentence;
  EXPECT_NE(c.sentence.find(
                "; the interval, which is not corrected, excludes zero, and by itself this pair would show a "
                "difference (p = 0.027), but after correction p is not below 0.05"),
            std::string::npos)
      << c.sentence;
}

TEST(Verdict, SpeaksOfVolumesInCubicMetres) {
  const auto results = drawn_campaign(2, 1, 8, [](std::size_t k, std::size_t, std::int64_t seed) {
    return Figures{{"explored_volume_m3", 100 + double(seed) + (k == 0 ? 10 : 0)}};
  });
  const std::string sentence = primary(compare_all(results, {.metric = "explored_volume_m3"})).sentence;
  EXPECT_NE(sentence.find(" m³ (95 % CI "), std::string::npos) << sentence;
  EXPECT_EQ(sentence.find("m^3"), std::string::npos) << sentence;
}

TEST(Verdict, SaysWhereNoDifferenceIsShownAndWhatWouldShowOne) {
  const Verdicts v = compare_all(coverage_campaign(1, {1, 1.01}, 3, 4));
  EXPECT_EQ(primary(v).shown, Shown::no_difference);
  EXPECT_EQ(v.sentence.rfind("no difference shown between A and B in coverage averaged over the flight: ", 0),
            0u)
      << v.sentence;
  EXPECT_NE(v.sentence.find("more seeds a cave ("), std::string::npos) << v.sentence;
  EXPECT_NE(v.sentence.find("would show a difference of 5 % ("), std::string::npos) << v.sentence;
  const Verdicts many = compare_all(coverage_campaign(1, {1, 1}, 3, 60));
  EXPECT_NE(many.sentence.find("a difference of 5 % ("), std::string::npos) << many.sentence;
  EXPECT_NE(many.sentence.find("would most likely have been shown"), std::string::npos) << many.sentence;
}

TEST(Verdict, OfEqualContestantsIsThatAllPairsAreEqual) {
  auto results = coverage_campaign(1, {1}, 3, 4);
  const auto first = results.trials;
  results.contestants.push_back({.name = "B", .policy = "", .version = "", .parameters = "", .settings = ""});
  for (TrialResult t : first) {
    t.contestant = 1;
    results.trials.push_back(t);
  }
  const Verdicts v = compare_all(results);
  EXPECT_EQ(primary(v).p_corrected, 1);
  EXPECT_EQ(v.sentence,
            "no difference shown between A and B in coverage averaged over the flight: all 12 pairs equal");
}

TEST(Verdict, CountsAFailedTrialAsAFlightThatFoundNothingMore) {
  TrialResult t;
  t.figures.assign(evaluation::metric_definitions().size(), std::nan(""));
  const auto of = [&](const char* name) { return figure_of(t, metric_index(name), 390); };
  EXPECT_TRUE(std::isnan(of("coverage"))) << "not failed: simply not known";
  t.failed = true;
  EXPECT_EQ(of("coverage"), 0);
  EXPECT_EQ(of("coverage_auc"), 0);
  EXPECT_EQ(of("completed"), 0);
  EXPECT_EQ(of("restricted_t90_s"), 390);
  EXPECT_TRUE(std::isnan(of("t90_s")));
  EXPECT_TRUE(std::isnan(of("map_error_mean_m")));
  figure(t, "coverage") = 0.4;  // it had come so far
  figure(t, "restricted_t50_s") = 70;
  figure(t, "completed") = 1;
  EXPECT_EQ(of("coverage"), 0.4);
  EXPECT_EQ(of("restricted_t50_s"), 70);
  EXPECT_EQ(of("completed"), 0) << "whatever the record says";
}

TEST(Verdict, KeepsFailedTrialsAndNamesThem) {
  auto results = coverage_campaign(2, {1, 1}, 2, 5);
  for (TrialResult& t : results.trials)
    if (t.contestant == 1 && t.seed == 1) {
      t.failed = true;
      figure(t, "coverage_auc") = std::nan("");
    }
  const Comparison c = primary(compare_all(results));
  EXPECT_EQ(c.pairs, 10u);
  EXPECT_EQ(c.failed_b, 2u);
  EXPECT_EQ(c.unknown, 0u);
  EXPECT_EQ(c.pair_b[0], 0);
  EXPECT_NE(c.sentence.find("; 2 trials of B failed)"), std::string::npos) << c.sentence;
}

TEST(Verdict, LeavesPairsOutWhoseFigureNobodyKnowsAndCountsThem) {
  auto results = coverage_campaign(2, {1, 1}, 2, 5);
  figure(results.trials[3], "coverage_auc") = std::nan("");
  const Verdicts v = compare_all(results);
  EXPECT_EQ(primary(v).pairs, 9u);
  EXPECT_EQ(primary(v).unknown, 1u);
  EXPECT_NE(v.sentence.find("9 pairs in 2 caves"), std::string::npos) << v.sentence;
  const Comparison& nowhere = *v.find(0, 1, metric_index("drift_percent"));
  EXPECT_EQ(nowhere.pairs, 0u);
  EXPECT_EQ(nowhere.unknown, 10u);
  EXPECT_EQ(nowhere.shown, Shown::no_difference);
  EXPECT_EQ(nowhere.sentence.rfind("nothing to compare in drift_percent", 0), 0u) << nowhere.sentence;
}

TEST(Verdict, OfSingleSeedsSpeaksOverCaves) {
  const Verdicts v = compare_all(coverage_campaign(4, {1.3, 1}, 8, 1));
  EXPECT_TRUE(primary(v).few_seeds);
  EXPECT_EQ(primary(v).interval.low, primary(v).interval_caves.low);
  EXPECT_EQ(primary(v).shown, Shown::a_better) << v.sentence;
  EXPECT_NE(v.sentence.find("over caves"), std::string::npos) << v.sentence;
  const Verdicts single = compare_all(coverage_campaign(4, {1.3, 1}, 1, 1));
  EXPECT_EQ(primary(single).shown, Shown::no_difference) << "one pair shows nothing";
}

TEST(Verdict, CorrectsForTheNumberOfPairsOfContestants) {
  const Verdicts v = compare_all(coverage_campaign(5, {1, 1.01, 1.02, 1.03}, 4, 6));
  std::vector<double> p, corrected;
  for (const Comparison& c : v.comparisons)
    if (c.metric == v.metric) p.push_back(c.test.p), corrected.push_back(c.p_corrected);
  ASSERT_EQ(p.size(), 6u);
  EXPECT_EQ(corrected, evaluation::holm(p));
  EXPECT_NE(primary(v).sentence.find("after correction"), std::string::npos);
}

TEST(Verdict, RanksWithLettersForWhatIsNotToldApart) {
  // C far ahead; A and D close together behind it, B far behind.
  const Verdicts v = compare_all(coverage_campaign(6, {1, 0.7, 1.4, 1.002}, 5, 8));
  ASSERT_EQ(v.ranking.size(), 4u);
  EXPECT_EQ(v.ranking[0].contestant, 2u);
  EXPECT_EQ(v.ranking[0].groups, "a");
  EXPECT_EQ(v.ranking[0].best, 1);
  EXPECT_EQ(v.ranking[0].worst, 1);
  EXPECT_EQ(v.ranking[1].groups, "b");
  EXPECT_EQ(v.ranking[2].groups, "b");
  EXPECT_EQ(v.ranking[1].best, 2);
  EXPECT_EQ(v.ranking[1].worst, 3);
  EXPECT_EQ(v.ranking[3].contestant, 1u);
  EXPECT_EQ(v.ranking[3].groups, "c");
  EXPECT_EQ(
      v.sentence.rfind("C is best in coverage averaged over the flight, shown better than all others", 0), 0u)
      << v.sentence;
}

TEST(Verdict, RanksByWhatAllContestantsFlew) {
  auto results = coverage_campaign(6, {1.1, 1, 0.9}, 4, 6);
  // A flew only the two caves where all cover least.
  std::erase_if(results.trials, [](auto& t) { return t.contestant == 0 && t.cave >= 2; });
  const Verdicts v = compare_all(results);
  EXPECT_EQ(v.ranking[0].contestant, 0u);
  EXPECT_EQ(v.ranking[2].contestant, 2u);
  EXPECT_EQ(primary(v, 0, 1).caves, 2u);
  EXPECT_EQ(primary(v, 1, 2).caves, 4u);
  // B's mean is over those two as well, 6 seeds each: not over the four it flew.
  const int metric = evaluation::metric_index("coverage_auc");
  double sum = 0;
  for (auto& t : results.trials)
    if (t.contestant == 1 && t.cave < 2) sum += figure(t, "coverage_auc");
  EXPECT_NEAR(comparable_means(results, metric)[1], sum / 12, 1e-12);
}

TEST(Verdict, GroupsOverlapWhereTheMiddleIsLikeBothEnds) {
  // A > C is shown, A ~ B and B ~ C are not: letters a, ab, b.
  auto results = drawn_campaign(3, 1, 8, [](std::size_t c, std::size_t, std::int64_t seed) {
    const double noise = 0.02 * static_cast<double>(seed % 4) * (seed % 2 ? 1 : -1);
    return Figures{{"coverage_auc", c == 0   ? 0.60 + 0.002 * double(seed)
                                    : c == 1 ? 0.585 + noise
                                             : 0.55 + 0.001 * double(seed)}};
  });
  const Verdicts v = compare_all(results);
  ASSERT_EQ(primary(v, 0, 2).shown, Shown::a_better);
  ASSERT_EQ(primary(v, 0, 1).shown, Shown::no_difference);
  ASSERT_EQ(primary(v, 1, 2).shown, Shown::no_difference);
  EXPECT_EQ(v.ranking[0].groups, "a");
  EXPECT_EQ(v.ranking[1].groups, "ab");
  EXPECT_EQ(v.ranking[2].groups, "b");
  EXPECT_EQ(v.sentence, "nobody is shown to be better in coverage averaged over the flight than A and B");
}

TEST(Verdict, OfAPolicyAgainstItselfIsNoDifferenceInAtLeast95Of100Campaigns) {
  int called = 0;
  for (std::uint64_t i = 0; i < 100; ++i)
    called +=
        primary(compare_all(coverage_campaign(1000 + i, {1, 1}, 6, 10), {.resamples = 400, .simulations = 0}))
            .shown != Shown::no_difference;
  EXPECT_LE(called, 5);
}

TEST(Verdict, OfFourEqualPoliciesCallsAnyDifferentInAtMost5Of100Campaigns) {
  int called = 0;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Verdicts v =
        compare_all(coverage_campaign(2000 + i, {1, 1, 1, 1}, 3, 6), {.resamples = 400, .simulations = 0});
    called += std::any_of(v.comparisons.begin(), v.comparisons.end(),
                          [](auto& c) { return c.shown != Shown::no_difference; });
  }
  EXPECT_LE(called, 5);
}

TEST(Verdict, FindsAPlantedDifferenceWithTheSeedsItForecasts) {
  // A pilot campaign of equal policies says how many seeds a difference of 5 % needs; with as many, most
  // campaigns with 5 % planted show it.
  const Verdicts pilot = compare_all(coverage_campaign(1, {1, 1}, 6, 10));
  const evaluation::Forecast f = primary(pilot).forecast_worthwhile;
  ASSERT_GE(f.seeds, 2);
  ASSERT_LT(f.seeds, 20);
  int shown = 0;
  for (std::uint64_t i = 0; i < 100; ++i)
    shown += primary(compare_all(coverage_campaign(3000 + i, {1.05, 1}, 6, f.seeds),
                                 {.resamples = 400, .simulations = 0}))
                 .shown == Shown::a_better;
  EXPECT_GE(shown, 65);  // 80 foreseen; 4 is the standard error, and the forecast has its own
}

TEST(Verdict, RefusesWhatIsNoCampaign) {
  auto results = coverage_campaign(1, {1, 1}, 2, 2);
  EXPECT_THROW(compare_all(results, {.metric = "beauty"}), core::InputError);
  auto twice = results;
  twice.trials.push_back(twice.trials.front());
  EXPECT_THROW(compare_all(twice), core::InputError);
  auto foreign = results;
  foreign.trials.front().cave = 7;
  EXPECT_THROW(compare_all(foreign), core::InputError);
  auto short_of_figures = results;
  short_of_figures.trials.front().figures.pop_back();
  EXPECT_THROW(compare_all(short_of_figures), core::InputError);
}

TEST(Verdict, OfNothingIsNothing) {
  EXPECT_EQ(compare_all({}).sentence, "nothing to compare: a verdict needs two contestants");
  CampaignResults unflown;
  unflown.contestants.resize(3);
  unflown.caves.resize(1);
  const Verdicts v = compare_all(unflown);
  EXPECT_EQ(v.ranking.size(), 3u);
  EXPECT_TRUE(std::isnan(v.ranking[0].mean));
}

}  // namespace
}  // namespace karst::campaign
