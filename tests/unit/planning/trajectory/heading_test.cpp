#include "core_stack/planning/trajectory/heading.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

TEST(TurnedEarly, ABendIsTurnedThroughEvenlyAndWhatIsFlownIntoStaysInView) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    const double bend_rad = random.uniform(-3, 3);
    std::vector<Vec3> path;
    for (int i = 0; i <= 40; ++i) path.push_back({0.1 * i, 0, 0});
    for (int i = 1; i <= 40; ++i)
      path.push_back(path[40] + 0.1 * i * Vec3(std::cos(bend_rad), std::sin(bend_rad), 0));
    const std::vector<double> along = headings_along(path, 0.8, 0);
    const std::vector<double> early = turned_early(path, along);
    RC_ASSERT(std::abs(early.front()) < 1e-9);
    RC_ASSERT(std::abs(wrap_angle(early.back() - bend_rad)) < 1e-9);
    double steepest = 0, turned = 0;
    for (std::size_t i = 1; i < early.size(); ++i) {
      const double step = wrap_angle(early[i] - early[i - 1]);
      steepest = std::max(steepest, std::abs(step)), turned += step;
      RC_ASSERT(std::abs(wrap_angle(early[i] - along[i])) < 0.6 + 1e-9);
      RC_ASSERT(step * bend_rad >= -1e-9);  // never the other way
    }
    RC_ASSERT(std::abs(turned - bend_rad) < 1e-6);
    // A right angle and less: spread over 3 m, of which a step is 0.1 m.
    if (std::abs(bend_rad) < std::numbers::pi / 2) RC_ASSERT(steepest < 1.1 * std::abs(bend_rad) / 30 + 1e-9);
  }));
}

}  // namespace
}  // namespace karst::core
