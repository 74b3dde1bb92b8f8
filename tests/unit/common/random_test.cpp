#include "core_stack/common/random.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace karst::core {
namespace {

TEST(Random, FirstNumbersAreThePublishedOnesOfSplitMix64) {
  // Reference values of the generator's author for seed 1234567, as in Rosetta Code's task "SplitMix64".
  Random r(1234567);
  EXPECT_EQ(r.bits(), 6457827717110365317ull);
  EXPECT_EQ(r.bits(), 3203168211198807973ull);
  EXPECT_EQ(r.bits(), 9817491932198370423ull);
  EXPECT_EQ(r.bits(), 4593380528125082431ull);
  EXPECT_EQ(r.bits(), 16408922859458223821ull);
}

TEST(Random, UniformHasTheMomentsOfItsDistribution) {
  Random r(42);
  const int n = 200000;
  double sum = 0, squares = 0, low = 1, high = 0;
  for (int i = 0; i < n; ++i) {
    const double u = r.uniform();
    sum += u, squares += u * u;
    low = std::min(low, u), high = std::max(high, u);
  }
  const double mean = sum / n, sigma = std::sqrt(1.0 / 12);
  EXPECT_NEAR(mean, 0.5, 5 * sigma / std::sqrt(n));
  EXPECT_NEAR(squares / n - mean * mean, 1.0 / 12, 0.001);
  EXPECT_GE(low, 0.0);
  EXPECT_LT(high, 1.0);
}

TEST(Random, UniformFillsItsBinsEvenly) {
  Random r(7);
  std::vector<int> bins(100);
  const int n = 100000;
  for (int i = 0; i < n; ++i) ++bins[static_cast<std::size_t>(r.uniform(0, 100))];
  double chi2 = 0;
  for (const int b : bins) chi2 += std::pow(b - n / 100.0, 2) / (n / 100.0);
  EXPECT_LT(chi2, 161);  // 99 degrees of freedom: exceeded once in ten thousand seeds
  EXPECT_GT(chi2, 50);
}

TEST(Random, NormalHasTheMomentsOfItsDistribution) {
  Random r(3);
  const int n = 200000;
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
  int within_one = 0;
  for (int i = 0; i < n; ++i) {
    const double x = r.normal();
    ASSERT_TRUE(std::isfinite(x));
    m1 += x, m2 += x * x, m3 += x * x * x, m4 += x * x * x * x;
    within_one += std::abs(x) < 1;
  }
  EXPECT_NEAR(m1 / n, 0, 0.012);
  EXPECT_NEAR(m2 / n, 1, 0.016);
  EXPECT_NEAR(m3 / n, 0, 0.045);
  EXPECT_NEAR(m4 / n, 3, 0.11);
  EXPECT_NEAR(double(within_one) / n, 0.682689, 0.0055);
}

TEST(Random, StreamsOfDifferentNamesOrSeedsDiffer) {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 200; ++seed)
    for (const char* purpose : {"wind", "lidar", "imu", "policy", ""})
      first.insert(Random::stream(seed, purpose).bits());
  EXPECT_EQ(first.size(), 1000u);
  EXPECT_EQ(Random::stream(5, "wind").bits(), Random::stream(5, "wind").bits());
}

TEST(Random, StreamsAreNotCorrelated) {
  Random a = Random::stream(1, "wind"), b = Random::stream(1, "lidar"), c = Random::stream(2, "wind");
  const int n = 100000;
  double ab = 0, ac = 0;
  for (int i = 0; i < n; ++i) {
    const double x = a.normal();
    ab += x * b.normal(), ac += x * c.normal();
  }
  EXPECT_NEAR(ab / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(ac / n, 0, 5 / std::sqrt(n));
}

}  // namespace
}  // namespace karst::core
