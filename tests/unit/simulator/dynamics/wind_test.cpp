#include "plugins/simulator/dynamics/wind.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using sim::Wind;
using sim::WindOptions;

TEST(Wind, GustsHaveTheirDeviationAndCorrelation) {
  WindOptions o;
  o.gust_mps = 3;
  o.correlation_s = 1;
  o.draught_east_mps = 0.5;
  Wind wind(o, core::Random(4));
  // 20000 s hold about 10000 independent gusts: the deviation is known to 1 %, correlation to 0.02.
  constexpr int kSteps = 200'000;
  std::vector<double> x;
  double z2 = 0;
  for (int i = 0; i < kSteps; ++i) {
    wind.advance(0.1);
    x.push_back(wind.velocity_mps().x() - 0.5);
    z2 += wind.velocity_mps().z() * wind.velocity_mps().z();
  }
  double mean = 0, variance = 0, lagged = 0;
  for (const double v : x) mean += v / kSteps;
  for (const double v : x) variance += v * v / kSteps;
  for (std::size_t i = 10; i < x.size(); ++i) lagged += x[i] * x[i - 10] / kSteps;
  EXPECT_NEAR(mean, 0, 0.12);
  EXPECT_NEAR(std::sqrt(variance), 3, 0.1);
  EXPECT_NEAR(lagged / variance, std::exp(-1.0), 0.05);
  EXPECT_NEAR(std::sqrt(z2 / kSteps), 1.5, 0.06);
}

TEST(Wind, WithoutGustsThereIsOnlyTheDraught) {
  WindOptions o;
  o.gust_mps = 0;
  o.draught_north_mps = 1.5;
  Wind wind(o, core::Random(4));
  wind.advance(0.005);
  EXPECT_EQ(wind.velocity_mps(), Vec3(0, 1.5, 0));
}

}  // namespace
}  // namespace karst::test
