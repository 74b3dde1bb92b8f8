#include "policies/surface_coverage/tour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core_stack/common/random.h"

namespace surface_coverage {
namespace {

double value_of(const std::vector<std::size_t>& order, const std::vector<double>& gain,
                const std::vector<double>& first_s, const std::vector<std::vector<double>>& between_s,
                double patience_s) {
  double sum = 0, t = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    t += i == 0 ? first_s[order[0]] : between_s[order[i - 1]][order[i]];
    sum += gain[order[i]] * std::exp(-t / patience_s);
  }
  return sum;
}

TEST(BestOrder, IsTheBestOfAllOrders) {
  karst::core::Random random(3);
  for (int n = 0; n <= 6; ++n)
    for (int run = 0; run < 20; ++run) {
      std::vector<double> gain, first_s;
      std::vector<std::vector<double>> between_s;
      for (int i = 0; i < n; ++i) {
        gain.push_back(random.uniform(0, 100));
        first_s.push_back(random.uniform(0, 30));
        between_s.emplace_back();
        for (int j = 0; j < n; ++j) between_s.back().push_back(random.uniform(0, 30));
      }
      std::vector<std::size_t> order(static_cast<std::size_t>(n));
      std::iota(order.begin(), order.end(), 0);
      double best = 0;
      do best = std::max(best, value_of(order, gain, first_s, between_s, 12));
      while (std::next_permutation(order.begin(), order.end()));
      const auto found = best_order(gain, first_s, between_s, 12);
      ASSERT_EQ(found.size(), gain.size());
      EXPECT_NEAR(value_of(found, gain, first_s, between_s, 12), best, 1e-9);
    }
}

TEST(BestOrder, EightPlacesInALineAreVisitedAlongIt) {
  std::vector<double> gain(8, 10), first_s;
  std::vector<std::vector<double>> between_s(8);
  const std::vector<int> place = {3, 7, 1, 5, 2, 8, 4, 6};
  for (const int a : place) first_s.push_back(a);
  for (std::size_t i = 0; i < 8; ++i)
    for (const int b : place) between_s[i].push_back(std::abs(place[i] - b));
  int last = 0;
  for (const std::size_t i : best_order(gain, first_s, between_s, 12)) EXPECT_EQ(place[i], ++last);
}

}  // namespace
}  // namespace surface_coverage
