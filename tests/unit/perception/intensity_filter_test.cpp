#include "core_stack/perception/intensity_filter.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

LidarScan scan_of(std::vector<float> range_m, std::vector<float> intensity) {
  return {0, nullptr, std::move(range_m), std::move(intensity)};
}

TEST(IntensityFilter, DropsTheWeakestReturnsNearTheSensorOnly) {
  std::vector<float> range_m, intensity;
  for (int i = 0; i < 100; ++i) {
    range_m.push_back(i % 2 == 0 ? 1.0f : 5.0f);
    intensity.push_back(static_cast<float>(i) / 100);
  }
  LidarScan scan = scan_of(range_m, intensity);
  drop_weakest_returns(scan, 10, 1.5);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(std::isnan(scan.range_m[i]), i < 10 && i % 2 == 0) << i;
  EXPECT_EQ(scan.intensity, intensity);
}

TEST(IntensityFilter, ThePercentileIsThatOfAllReturns) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    const double percentile = random.uniform(0, 100);
    LidarScan scan;
    for (int i = 0; i < 200; ++i) {
      const double kind = random.uniform();
      scan.range_m.push_back(kind < 0.1   ? std::numeric_limits<float>::quiet_NaN()
                             : kind < 0.2 ? std::numeric_limits<float>::infinity()
                                          : static_cast<float>(random.uniform(0.3, 3)));
      scan.intensity.push_back(static_cast<float>(std::floor(random.uniform(0, 50)) / 50));  // many ties
    }
    const LidarScan before = scan;
    drop_weakest_returns(scan, percentile, 1.5);
    std::vector<float> returns;
    for (std::size_t i = 0; i < 200; ++i)
      if (std::isfinite(before.range_m[i])) returns.push_back(before.intensity[i]);
    for (std::size_t i = 0; i < 200; ++i) {
      const auto weaker_or_equal =
          std::count_if(returns.begin(), returns.end(), [&](float v) { return v <= before.intensity[i]; });
      const bool weak =
          100.0 * static_cast<double>(weaker_or_equal) <= percentile * static_cast<double>(returns.size());
      const bool drop = before.range_m[i] < 1.5f && weak;
      RC_ASSERT(std::isnan(scan.range_m[i]) == (std::isnan(before.range_m[i]) || drop));
      if (!drop && !std::isnan(before.range_m[i])) RC_ASSERT(scan.range_m[i] == before.range_m[i]);
    }
  }));
}

TEST(IntensityFilter, LeavesScansAloneThatItCannotJudge) {
  const std::vector<float> ranges{1, 1, 1, std::numeric_limits<float>::quiet_NaN()};
  LidarScan no_intensity = scan_of({1, 1, 1}, {});
  drop_weakest_returns(no_intensity, 10, 1.5);
  EXPECT_EQ(no_intensity.range_m, (std::vector<float>{1, 1, 1}));
  LidarScan empty;
  drop_weakest_returns(empty, 10, 1.5);
  LidarScan nothing_seen = scan_of(
      {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}, {0.5f, 0.1f});
  drop_weakest_returns(nothing_seen, 50, 2);
  EXPECT_EQ(nothing_seen.range_m[1], std::numeric_limits<float>::infinity());
  LidarScan uniform = scan_of({1, 1, 1, 1}, {0.5f, 0.5f, 0.5f, std::numeric_limits<float>::quiet_NaN()});
  drop_weakest_returns(uniform, 50, 2);
  EXPECT_EQ(uniform.range_m, (std::vector<float>{1, 1, 1, 1})) << "none is weaker than the others";
  LidarScan off = scan_of({1, 1}, {0.0f, 1.0f});
  drop_weakest_returns(off, 0, 2);
  EXPECT_EQ(off.range_m, (std::vector<float>{1, 1}));
}

TEST(IntensityFilter, TheRuleThatIsChosenIsTheOneThatIsUsed) {
  const auto left = [](DustRule rule) {
    auto model = std::make_shared<LidarModel>();
    model->columns = 64;
    model->elevation_rad = {0.1f, 0.0f, -0.1f};
    LidarScan scan{0, model, std::vector<float>(192, 1.0f), std::vector<float>(192, 0.2f)};
    scan.intensity[70] = 0.01f;                            // weak, on the surface
    scan.range_m[100] = 0.5f, scan.intensity[100] = 0.2f;  // off the surface, not weak
    filter_low_intensity(scan, {10, 1.5, rule, {}});
    return std::pair(!std::isnan(scan.range_m[70]), !std::isnan(scan.range_m[100]));
  };
  EXPECT_EQ(left(DustRule::none), std::pair(true, true));
  EXPECT_EQ(left(DustRule::lonely), std::pair(true, false));
  EXPECT_EQ(left(DustRule::both), std::pair(false, false));
  EXPECT_EQ(left(DustRule::percentile), std::pair(false, true));
}

}  // namespace
}  // namespace karst::core
