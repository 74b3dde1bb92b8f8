// Wilcoxon's test against enumeration of all signs, published critical values, and SciPy.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "sdk/evaluation/statistics/statistics.h"

namespace karst::evaluation {
namespace {

using List = std::vector<double>;

SignedRank test_of(const List& differences) { return signed_rank(std::span<const double>(differences)); }

/// Two-sided p by trying every pattern of signs, with ranks counted pair by pair.
double enumerated_p(const List& all) {
  List d;
  for (const double v : all)
    if (v != 0) d.push_back(v);
  List rank;
  double total = 0, positive = 0;
  for (const double v : d) {
    double below = 0, equal = 0;
    for (const double w : d) below += std::abs(w) < std::abs(v), equal += std::abs(w) == std::abs(v);
    rank.push_back(below + (equal + 1) / 2);
    total += rank.back();
    if (v > 0) positive += rank.back();
  }
  const double observed = std::min(positive, total - positive);
  std::size_t as_far = 0;
  const std::size_t patterns = std::size_t{1} << d.size();
  for (std::size_t signs = 0; signs < patterns; ++signs) {
    double sum = 0;
    for (std::size_t i = 0; i < d.size(); ++i)
      if (signs >> i & 1) sum += rank[i];
    as_far += sum <= observed;
  }
  return std::min(1.0, 2 * static_cast<double>(as_far) / static_cast<double>(patterns));
}

RC_GTEST_PROP(SignedRank, EqualsTheEnumerationOfAllSignsWithTiesAndZeros, ()) {
  const auto whole = *rc::gen::resize(12, rc::gen::container<std::vector<int>>(rc::gen::inRange(-6, 7)));
  const List d(whole.begin(), whole.end());
  RC_PRE(d.size() <= 14u);
  const SignedRank t = test_of(d);
  RC_ASSERT(std::abs(t.p - enumerated_p(d)) < 1e-12);
  RC_ASSERT(t.zeros + t.positive + t.negative == d.size());
}

RC_GTEST_PROP(SignedRank, DoesNotCareForSignOrderOrScale, ()) {
  auto d = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-1000, 1000));
  List one(d.begin(), d.end()), other;
  for (auto v = d.rbegin(); v != d.rend(); ++v) other.push_back(-0.25 * *v);
  const SignedRank a = test_of(one), b = test_of(other);
  RC_ASSERT(a.p == b.p);
  RC_ASSERT(a.rank_sum_positive == b.rank_sum_negative);
  RC_ASSERT(rank_biserial(a) == -rank_biserial(b));
}

/// Differences 1 .. n of which those with negative sign have ranks that sum to `w`.
List with_rank_sum(int n, int w) {
  List d;
  for (int r = n; r >= 1; --r) {
    const bool negative = r <= w;
    if (negative) w -= r;
    d.push_back(negative ? -r : r);
  }
  return d;
}

TEST(SignedRank, AgreesWithPublishedCriticalValues) {
  // Greatest rank sum that is significant at 5 %, two-sided (Wilcoxon and Wilcox, 1964, and every table
  // since).
  for (const auto& [n, w] :
       {std::pair(6, 0), {7, 2}, {8, 3}, {9, 5}, {10, 8}, {11, 10}, {12, 13}, {15, 25}, {20, 52}, {25, 89}}) {
    EXPECT_LE(test_of(with_rank_sum(n, w)).p, 0.05) << n;
    EXPECT_GT(test_of(with_rank_sum(n, w + 1)).p, 0.05) << n;
    EXPECT_EQ(test_of(with_rank_sum(n, w)).rank_sum_negative, w);
  }
}

TEST(SignedRank, AgreesWithSciPy) {
  // scipy 1.10: wilcoxon(d, mode="exact").
  const List darwin{6, -8, 14, 16, 23, 24, 28, 29, 41, -48, 49, 56, 60, -67, 75};
  const SignedRank exact = test_of(darwin);
  EXPECT_TRUE(exact.exact);
  EXPECT_EQ(exact.rank_sum_negative, 26);
  EXPECT_NEAR(exact.p, 0.05535888671875, 1e-14);
  // scipy 1.10: wilcoxon(d, mode="approx", correction=True): 58 differences that are not zero, with ties.
  List many;
  for (int i = 0; i < 60; ++i) many.push_back((i * i * 7 + 3 * i) % 211 - 90);
  const SignedRank approximate = test_of(many);
  EXPECT_FALSE(approximate.exact);
  EXPECT_EQ(approximate.zeros, 2u);
  EXPECT_EQ(std::min(approximate.rank_sum_positive, approximate.rank_sum_negative), 599.5);
  EXPECT_NEAR(approximate.p, 0.04789282657426649, 1e-12);
  // scipy 1.10, exact, n = 50: the largest that is counted.
  List fifty;
  for (int i = 0; i < 50; ++i) fifty.push_back(2.5 * (i / 3 % 2 ? -1 : 1) * (i + 1) + (i % 4 ? 3 : -1));
  const SignedRank largest = test_of(fifty);
  EXPECT_TRUE(largest.exact);
  EXPECT_NEAR(largest.p, 0.8109402812359416, 1e-12);
}

TEST(SignedRank, OfNoDifferencesShowsNone) {
  for (const List& d : {List{}, List{0, 0, 0}}) {
    EXPECT_EQ(test_of(d).p, 1);
    EXPECT_EQ(rank_biserial(test_of(d)), 0);
  }
}

TEST(SignedRank, CountsThePairsOfAllCavesTogether) {
  const Differences caves{{1, -2}, {}, {3, 4, 0}};
  const SignedRank t = signed_rank(caves);
  EXPECT_EQ(t.rank_sum_positive, 1 + 3 + 4);
  EXPECT_EQ(t.rank_sum_negative, 2);
  EXPECT_EQ(t.zeros, 1u);
  EXPECT_NEAR(rank_biserial(t), 0.6, 1e-15);
}

}  // namespace
}  // namespace karst::evaluation
