// Means, intervals, corrections and forecasts against closed forms, SciPy and simulated campaigns.
#include "sdk/evaluation/statistics/statistics.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>

#include "core_stack/common/random.h"
#include "sdk/evaluation/statistics/quantiles.h"
#include "sdk/evaluation/statistics/spread.h"

namespace karst::evaluation {
namespace {

using core::Random;

TEST(MeanDifference, WeighsCavesTheSame) {
  EXPECT_EQ(mean_difference({{1, 1, 1, 1}, {}, {5}}), 3);
  EXPECT_TRUE(std::isnan(mean_difference({})));
  EXPECT_TRUE(std::isnan(mean_difference({{}, {}})));
}

TEST(StandardizedDifference, IsTheMeanOverTheSpreadWithinCaves) {
  // Variances 2 (one degree of freedom) and 1 (two): pooled 4 / 3. Means 3 and 5.
  EXPECT_NEAR(standardized_difference({{2, 4}, {4, 5, 6}}), 4 / std::sqrt(4.0 / 3), 1e-12);
  EXPECT_TRUE(std::isnan(standardized_difference({{3, 3}, {7}})));
}

TEST(Quantiles, AgreeWithSciPy) {  // scipy 1.10: t.ppf, norm.ppf, chi2.ppf
  EXPECT_NEAR(student_t_quantile(0.975, 4.5), 2.6589123472044034, 1e-9);
  EXPECT_NEAR(student_t_quantile(0.975, 2), 4.302652729911275, 1e-9);
  EXPECT_NEAR(normal_quantile(0.8), 0.8416212335729143, 1e-12);
  EXPECT_NEAR(chi_squared_quantile(0.1, 7.3), 3.0274296199051185, 1e-9);
}

TEST(SpreadWithinCaves, HasTheDegreesOfFreedomOfWelchAndSatterthwaite) {
  const Spread s = spread_within_caves({{1, 3, 5}, {2, 4}});
  const double one = 4.0 / 3, two = 2.0 / 2;  // squared standard errors of the caves' means
  EXPECT_NEAR(s.variance, (one + two) / 4, 1e-12);
  EXPECT_NEAR(s.plug_in, (one * 2 / 3 + two / 2) / 4, 1e-12);
  EXPECT_NEAR(s.degrees, (one + two) * (one + two) / (one * one / 2 + two * two), 1e-12);
  EXPECT_TRUE(std::isnan(spread_within_caves({{1, 2}, {3}}).variance));
}

TEST(Bootstrap, MeetsStudentsIntervalOfManyNormalPairs) {
  Random random(3);
  std::vector<double> d(400);
  for (double& v : d) v = 2 + random.normal();
  const Interval i = bootstrap_interval({d}, Resampled::seeds, {.resamples = 20000});
  const double half = student_t_quantile(0.975, 399) * std::sqrt(variance_of(d) / 400);
  EXPECT_NEAR(i.low, mean_of(d) - half, 0.03 * half);
  EXPECT_NEAR(i.high, mean_of(d) + half, 0.03 * half);
}

TEST(Bootstrap, KeepsTheSkewnessOfTheMean) {
  Random random(3);
  std::vector<double> d(12);
  for (double& v : d) v = std::exp(1.5 * random.normal());
  const Interval i = bootstrap_interval({d}, Resampled::seeds);
  EXPECT_GT(i.high - mean_of(d), 1.1 * (mean_of(d) - i.low));
}

TEST(Bootstrap, IsTheSameForTheSameSeedOnly) {
  const Differences d{{1, 4, -2, 3}, {0.5, 2, 2.5}};
  const Interval a = bootstrap_interval(d, Resampled::seeds), b = bootstrap_interval(d, Resampled::seeds);
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
  EXPECT_NE(bootstrap_interval(d, Resampled::seeds, {.seed = 2}).low, a.low);
}

TEST(Bootstrap, OverCavesSeesHowCavesDifferAndOverSeedsDoesNot) {
  const Differences d{{10, 10.1, 9.9}, {-4, -4.1, -3.9}, {3, 3.1, 2.9}};
  const Interval seeds = bootstrap_interval(d, Resampled::seeds),
                 caves = bootstrap_interval(d, Resampled::caves);
  EXPECT_GT(seeds.low, 2.5);
  EXPECT_LT(caves.low, 0);
  EXPECT_TRUE(seeds.excludes(0));
  EXPECT_FALSE(caves.excludes(0));
}

TEST(Bootstrap, DoesNotPretendToKnowWhatTooFewPairsCannotTell) {
  EXPECT_TRUE(std::isnan(bootstrap_interval({{1}, {2, 3}}, Resampled::seeds).low));
  EXPECT_TRUE(std::isnan(bootstrap_interval({{1, 2, 3}}, Resampled::caves).low));
  EXPECT_TRUE(std::isnan(bootstrap_interval({}, Resampled::seeds).low));
  EXPECT_FALSE(bootstrap_interval({}, Resampled::seeds).excludes(0));
  const Interval all_the_same = bootstrap_interval({{2, 2}, {2, 2}}, Resampled::seeds);
  EXPECT_EQ(all_the_same.low, 2);
  EXPECT_EQ(all_the_same.high, 2);
}

/// Campaigns of pairs without any true difference: how often the interval misses zero, and how often it and
/// the test together call a difference.
struct Calibration {
  double missed = 0, called = 0;
};
Calibration calibrate(int caves, int seeds, const std::function<double(Random&, int)>& difference,
                      int campaigns = 1000) {
  Random random(11);
  Calibration c;
  for (int i = 0; i < campaigns; ++i) {
    Differences d(static_cast<std::size_t>(caves));
    for (int cave = 0; cave < caves; ++cave)
      for (int s = 0; s < seeds; ++s) d[static_cast<std::size_t>(cave)].push_back(difference(random, cave));
    const bool missed =
        bootstrap_interval(d, Resampled::seeds, {.resamples = 400, .seed = random.bits()}).excludes(0);
    c.missed += missed;
    c.called += missed && signed_rank(d).p < 0.05;
  }
  return {c.missed / campaigns, c.called / campaigns};
}

double student3(Random& r) {  // heavy tails
  double chi = 0;
  for (int i = 0; i < 3; ++i) chi += std::pow(r.normal(), 2);
  return r.normal() / std::sqrt(chi / 3);
}
double censored_time(Random& r, double log_median) {
  return std::min(std::exp(log_median + 0.4 * r.normal()), 390.0);
}

// 1000 campaigns: a share of 5 % is told with a standard error of 0.7 points; bounds are three of them off.
constexpr double kMaxMissed = 0.071, kMaxCalled = 0.05;

TEST(Calibration, OfNormalDifferences) {
  const Calibration c = calibrate(6, 10, [](Random& r, int) { return r.normal(); });
  EXPECT_NEAR(c.missed, 0.05, 0.021);
  EXPECT_LE(c.called, kMaxCalled);
  EXPECT_GT(c.called, 0.01) << "a rule that never speaks would pass as well";
}
TEST(Calibration, OfHeavyTails) {
  const Calibration c = calibrate(6, 10, [](Random& r, int) { return student3(r); });
  EXPECT_LE(c.missed, kMaxMissed);
  EXPECT_LE(c.called, kMaxCalled);
}
TEST(Calibration, OfCavesThatSpreadDifferently) {
  const Calibration c =
      calibrate(6, 10, [](Random& r, int cave) { return std::pow(3.0, cave) * r.normal(); });
  EXPECT_LE(c.missed, kMaxMissed);
  EXPECT_LE(c.called, kMaxCalled);
}
TEST(Calibration, OfTies) {
  const Calibration c = calibrate(6, 10, [](Random& r, int) { return std::round(0.7 * r.normal()); });
  EXPECT_LE(c.missed, kMaxMissed);
  EXPECT_LE(c.called, kMaxCalled);
}
TEST(Calibration, OfTimesCutAtTheHorizon) {
  for (const double log_median : {5.3, 6.1}) {  // few reach the horizon of 390 s, and two in three
    const Calibration c = calibrate(
        6, 10, [&](Random& r, int) { return censored_time(r, log_median) - censored_time(r, log_median); });
    EXPECT_LE(c.missed, kMaxMissed) << log_median;
    EXPECT_LE(c.called, kMaxCalled) << log_median;
  }
}
TEST(Calibration, OfFewSeeds) {
  for (const auto& [caves, seeds] : {std::pair(6, 3), {3, 5}, {1, 10}}) {
    const Calibration c = calibrate(caves, seeds, [](Random& r, int) { return r.normal(); });
    EXPECT_LE(c.missed, kMaxMissed) << caves << " x " << seeds;
    EXPECT_LE(c.called, kMaxCalled) << caves << " x " << seeds;
  }
}

TEST(Holm, IsTheStepDownOfTheTextbook) {
  // Sorted .005 .01 .03 .04 times 4 3 2 1, and never below the one before: .02 .03 .06 .06
  const std::vector<double> corrected = holm({0.01, 0.04, 0.03, 0.005}), expected{0.03, 0.06, 0.06, 0.02};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(corrected[i], expected[i], 1e-15);
  EXPECT_EQ(holm({0.6, 0.7}), (std::vector<double>{1, 1}));
  EXPECT_EQ(holm({}), std::vector<double>{});
}

TEST(Holm, LeavesOutTestsThatWereNotMade) {
  const auto corrected = holm({0.02, std::nan(""), 0.5});
  EXPECT_EQ(corrected[0], 0.04);
  EXPECT_TRUE(std::isnan(corrected[1]));
}

RC_GTEST_PROP(Holm, IsBetweenThePlainValueAndBonferronis, ()) {
  const auto parts = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 1001));
  std::vector<double> p;
  for (const int i : parts) p.push_back(i / 1000.0);
  const auto corrected = holm(p);
  for (std::size_t i = 0; i < p.size(); ++i) {
    RC_ASSERT(corrected[i] >= p[i]);
    RC_ASSERT(corrected[i] <= std::min(1.0, p[i] * static_cast<double>(p.size())));
    for (std::size_t k = 0; k < p.size(); ++k) RC_ASSERT(p[i] > p[k] || corrected[i] <= corrected[k]);
  }
}

/// Normal pairs whose spread within each cave is exactly 1.
Differences unit_pairs(int caves, int seeds, double mean) {
  Differences d(static_cast<std::size_t>(caves));
  for (auto& cave : d) {
    for (int s = 0; s < seeds; ++s) cave.push_back(normal_quantile((s + 0.5) / seeds));
    const double scale = 1 / std::sqrt(variance_of(cave));
    for (double& v : cave) v = mean + v * scale;
  }
  return d;
}

TEST(Forecast, MeetsTheSampleSizeOfTheSignedRankTest) {
  // (1.96 + 0.84)^2 / 0.4^2 = 49 pairs for a test of the mean; the signed ranks are 3 / pi = 0.955 as
  // efficient: 51.4 pairs, 12.8 a cave.
  const Forecast f = forecast_seeds(unit_pairs(4, 40, 7), 0.4);
  EXPECT_NEAR(f.seeds, 13, 1.5);
  EXPECT_LT(f.low, f.seeds);
  EXPECT_GT(f.high, f.seeds);
  // A fourth of the effect: too many to simulate one by one. 212 in 4000 simulated campaigns of 200 to 220
  // seeds (t test and signed ranks together; numpy 1.24, scipy 1.10).
  EXPECT_NEAR(forecast_seeds(unit_pairs(4, 40, 7), 0.1).seeds, 212, 0.15 * 212);
}

TEST(Forecast, AsksForMoreTheSmallerTheEffectAndTheMoreTests) {
  const Differences d = unit_pairs(3, 20, 0);
  const int plain = forecast_seeds(d, 0.5).seeds;
  EXPECT_GT(forecast_seeds(d, 0.25).seeds, 3 * plain);
  EXPECT_GT(forecast_seeds(d, 0.5, {.tests = 6}).seeds, plain);
  EXPECT_EQ(forecast_seeds(d, -0.5).seeds, forecast_seeds(d, -0.5).seeds);
  EXPECT_NEAR(forecast_seeds(d, -0.5).seeds, plain, 2);
}

TEST(Forecast, OfAnEffectThatIsBarelyThereIsNever) {
  EXPECT_EQ(forecast_seeds(unit_pairs(3, 20, 0), 1e-4).seeds, Forecast::kNever);
  EXPECT_EQ(forecast_seeds(unit_pairs(3, 20, 0), 0).seeds, Forecast::kNever);
  EXPECT_EQ(forecast_seeds({{1}, {2, 3}}, 1).seeds, Forecast::kNever);
  EXPECT_EQ(forecast_seeds({}, 1).seeds, Forecast::kNever);
  const Forecast f = forecast_seeds_as_observed(unit_pairs(2, 10, 0.05));
  EXPECT_EQ(f.high, Forecast::kNever) << "the effect may as well be none";
}

TEST(Forecast, AsObservedIsTheOneOfTheObservedEffect) {
  const Differences d = unit_pairs(4, 40, 0.4);
  const Forecast f = forecast_seeds_as_observed(d);
  EXPECT_EQ(f.seeds, forecast_seeds(d, mean_difference(d)).seeds);
  EXPECT_LT(f.low, f.seeds);
  EXPECT_GT(f.high, f.seeds);
}

}  // namespace
}  // namespace karst::evaluation
