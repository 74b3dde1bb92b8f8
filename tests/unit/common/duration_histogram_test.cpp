#include "core_stack/common/duration_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

TEST(DurationHistogram, HasNothingToSayOfNothing) {
  const DurationHistogram none;
  EXPECT_EQ(none.count(), 0u);
  EXPECT_EQ(none.quantile(0.5), 0);
  EXPECT_EQ(none.max(), 0);
}

// The oracle sorts what was added.
TEST(DurationHistogram, QuantilesAreThoseOfTheSortedDurationsUpToAThirtySecond) {
  for (int seed = 1; seed <= 20; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    DurationHistogram histogram;
    std::vector<TimeNs> all;
    const auto count = static_cast<int>(random.uniform(1, 3000));
    for (int i = 0; i < count; ++i) {  // from a nanosecond to minutes, evenly by the logarithm
      all.push_back(static_cast<TimeNs>(std::exp2(random.uniform(0, 38))));
      histogram.add(all.back());
    }
    std::sort(all.begin(), all.end());
    for (const double q : {0.0, 0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const auto rank = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(q * count)));
      const TimeNs exact = all[rank - 1];
      EXPECT_GE(histogram.quantile(q), exact);
      EXPECT_LE(static_cast<double>(histogram.quantile(q)), static_cast<double>(exact) * (1 + 1.0 / 32)) << q;
    }
    EXPECT_EQ(histogram.max(), all.back());
    EXPECT_EQ(histogram.quantile(1), all.back());
    TimeNs total = 0;
    for (const TimeNs t : all) total += t;
    EXPECT_EQ(histogram.total(), total);
    EXPECT_EQ(histogram.count(), all.size());
  }
}

TEST(DurationHistogram, SmallDurationsAreExact) {
  for (TimeNs t = 0; t < 64; ++t) {
    DurationHistogram one;
    one.add(t);
    one.add(1000);
    EXPECT_EQ(one.quantile(0.5), t);
  }
}

TEST(DurationHistogram, WhatIsOutOfItsRangeCountsAtTheEnds) {
  DurationHistogram histogram;
  histogram.add(-5);
  histogram.add(INT64_MAX);
  EXPECT_EQ(histogram.quantile(0.5), 0);
  EXPECT_NEAR(seconds(histogram.max()), 18.3 * 60, 10);
}

}  // namespace
}  // namespace karst::core
