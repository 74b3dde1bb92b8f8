// Wilcoxon's signed-rank test (Wilcoxon, 1945). Ranks are doubled, so that mean ranks of ties are integers.
#include <algorithm>
#include <cmath>

#include "sdk/evaluation/statistics/statistics.h"

namespace karst::evaluation {
namespace {

constexpr std::size_t kMaxExact = 50;  // counts of 2^50 sign patterns are exact in a double

/// Probability that the positive ranks sum to at most `doubled_sum` if every sign is equally likely: counts
/// sign patterns, one rank at a time.
double lower_tail(const std::vector<std::size_t>& doubled_ranks, std::size_t doubled_sum) {
  std::size_t total = 0;
  for (const std::size_t r : doubled_ranks) total += r;
  std::vector<double> patterns(total + 1, 0.0);
  patterns[0] = 1;
  std::size_t reached = 0;
  for (const std::size_t r : doubled_ranks) {
    for (std::size_t s = reached + 1; s-- > 0;) patterns[s + r] += patterns[s];
    reached += r;
  }
  double count = 0;
  for (std::size_t s = 0; s <= std::min(doubled_sum, total); ++s) count += patterns[s];
  return std::ldexp(count, -static_cast<int>(doubled_ranks.size()));
}

/// Two-sided p-value of the lesser rank sum. `ties`: sum of t^3 - t over groups of t equal differences.
double normal_p(double n, double lesser_sum, double ties) {
  const double mean = n * (n + 1) / 4, variance = n * (n + 1) * (2 * n + 1) / 24 - ties / 48;
  const double z = std::min(0.0, lesser_sum + 0.5 - mean) / std::sqrt(variance);
  return std::erfc(-z / std::sqrt(2.0));
}

}  // namespace

SignedRank signed_rank(std::span<const double> differences, std::size_t max_exact) {
  SignedRank test;
  std::vector<double> nonzero;
  for (const double d : differences)
    if (d != 0) nonzero.push_back(d);
  test.zeros = differences.size() - nonzero.size();
  std::sort(nonzero.begin(), nonzero.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });

  std::vector<std::size_t> doubled_ranks(nonzero.size());
  double ties = 0;
  for (std::size_t i = 0, end = 0; i < nonzero.size(); i = end) {
    while (end < nonzero.size() && std::abs(nonzero[end]) == std::abs(nonzero[i])) ++end;
    for (std::size_t k = i; k < end; ++k) doubled_ranks[k] = i + end + 1;  // twice the mean of i + 1 .. end
    const auto t = static_cast<double>(end - i);
    ties += t * t * t - t;
  }
  std::size_t doubled_positive = 0, doubled_negative = 0;
  for (std::size_t i = 0; i < nonzero.size(); ++i) {
    ++(nonzero[i] > 0 ? test.positive : test.negative);
    (nonzero[i] > 0 ? doubled_positive : doubled_negative) += doubled_ranks[i];
  }
  test.rank_sum_positive = static_cast<double>(doubled_positive) / 2;
  test.rank_sum_negative = static_cast<double>(doubled_negative) / 2;
  if (nonzero.empty()) return test;
  test.exact = nonzero.size() <= std::min(max_exact, kMaxExact);
  const std::size_t lesser = std::min(doubled_positive, doubled_negative);
  test.p = test.exact ? std::min(1.0, 2 * lower_tail(doubled_ranks, lesser))
                      : normal_p(static_cast<double>(nonzero.size()), static_cast<double>(lesser) / 2, ties);
  return test;
}

SignedRank signed_rank(const Differences& differences, std::size_t max_exact) {
  std::vector<double> all;
  for (const auto& cave : differences) all.insert(all.end(), cave.begin(), cave.end());
  return signed_rank(std::span<const double>(all), max_exact);
}

double rank_biserial(const SignedRank& test) {
  const double sum = test.rank_sum_positive + test.rank_sum_negative;
  return sum > 0 ? (test.rank_sum_positive - test.rank_sum_negative) / sum : 0;
}

}  // namespace karst::evaluation
