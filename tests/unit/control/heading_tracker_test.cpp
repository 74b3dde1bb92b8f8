#include "core_stack/control/heading_tracker.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core_stack/common/geometry.h"
#include "core_stack/common/random.h"

namespace karst::core {
namespace {

constexpr double kDt = 0.01;
const HeadingLimits kLimits{1.0, 2.0};

TEST(HeadingTracker, TurnsTheShorterWayAcrossThePole) {
  HeadingState s{3.0, 0};
  for (int i = 0; i < 5; ++i) s = step_heading(s, -3.0, 0, kLimits, kDt);
  EXPECT_GT(s.rate_radps, 0);
  for (int i = 0; i < 300; ++i) s = step_heading(s, -3.0, 0, kLimits, kDt);
  EXPECT_NEAR(s.heading_rad, -3.0, 1e-3);
}

TEST(HeadingTracker, FollowsASteadyTurnWithoutLag) {
  HeadingState s;
  double target = 0;
  for (int i = 0; i < 600; ++i) {
    target = wrap_angle(target + 0.6 * kDt);
    s = step_heading(s, target, 0.6, kLimits, kDt);
  }
  EXPECT_NEAR(wrap_angle(s.heading_rad - target), 0, 5e-3);
  EXPECT_NEAR(s.rate_radps, 0.6, 1e-3);
}

RC_GTEST_PROP(HeadingTracker, StepsStayWithinLimitsAndDoNotOvershoot, (std::uint64_t seed)) {
  Random r(seed);
  const double target = r.uniform(-3.1, 3.1);
  HeadingState s{r.uniform(-3.1, 3.1), 0};
  const double first = wrap_angle(target - s.heading_rad);
  for (int i = 0; i < 1000; ++i) {
    const HeadingState next = step_heading(s, target, 0, kLimits, kDt);
    RC_ASSERT(std::abs(next.rate_radps) <= kLimits.max_rate_radps + 1e-12);
    RC_ASSERT(std::abs(next.rate_radps - s.rate_radps) <= kLimits.max_acceleration_radps2 * kDt + 1e-12);
    RC_ASSERT(std::abs(next.heading_rad) <= std::numbers::pi + 1e-12);
    s = next;
    const double error = wrap_angle(target - s.heading_rad);
    RC_ASSERT(error * first >= -0.01 * std::abs(first) || std::abs(error) < 0.01);
  }
  RC_ASSERT(std::abs(wrap_angle(target - s.heading_rad)) < 1e-3);
}

}  // namespace
}  // namespace karst::core
