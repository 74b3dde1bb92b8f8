#include "core_stack/control/mass_estimate.h"

#include <gtest/gtest.h>

#include <limits>

#include "core_stack/control/se3_controller.h"
#include "tests/unit/control/quadrotor_model.h"

namespace karst::core::test {
namespace {

constexpr double kDescribed_kg = 2.0;

struct Hover {
  double mass_kg = 0, last_error_m = 0;
};

/// Hovers for so long with another mass than described; `learning` uses the estimate.
Hover hover(double true_mass_kg, double gust_mps, bool learning, double duration_s) {
  QuadrotorModel quad;
  quad.mass_kg = true_mass_kg;
  quad.gust_mps = gust_mps;
  quad.thrust_n = true_mass_kg * 9.81;
  Se3Controller controller({}, kDescribed_kg, 60, 6);
  MassEstimate mass(kDescribed_kg);
  Reference reference;
  AttitudeRateCommand command;
  for (int k = 0; k * 0.001 < duration_s; ++k) {
    if (k % 5 == 0) mass.on_specific_force(quad.specific_force_mps2.z());
    if (k % 10 == 0) {
      if (k > 0) mass.update(command.thrust_n, true, 0.01);
      if (learning) controller.set_mass_kg(mass.mass_kg());
      command = controller.update(quad.state, reference, 0.01);
    }
    quad.step(command, 0.001);
  }
  return {mass.mass_kg(), std::abs(quad.state.position.z())};
}

class AnotherMass : public ::testing::TestWithParam<double> {};

TEST_P(AnotherMass, IsFoundAndFlownWithoutAnErrorOfHeight) {
  const double truth = GetParam() * kDescribed_kg;
  const Hover still = hover(truth, 0, true, 20);
  EXPECT_NEAR(still.mass_kg, truth, 0.005 * truth);
  EXPECT_LT(still.last_error_m, 0.01);
  EXPECT_NEAR(hover(truth, 3, true, 60).mass_kg, truth, 0.05 * truth) << "in gusts of 3 m/s";
}
INSTANTIATE_TEST_SUITE_P(Shares, AnotherMass, ::testing::Values(0.7, 0.85, 1.0, 1.15, 1.3));

TEST(MassEstimate, LearnsNothingOnTheGround) {
  MassEstimate mass(kDescribed_kg);
  for (int i = 0; i < 1000; ++i) {
    mass.on_specific_force(9.81);  // the ground carries it
    mass.update(5, false, 0.01);
  }
  EXPECT_EQ(mass.mass_kg(), kDescribed_kg);
}

TEST(MassEstimate, StaysWithinBoundsWhateverComes) {
  MassEstimate mass(kDescribed_kg);
  for (int i = 0; i < 5000; ++i) {
    mass.on_specific_force(i % 3 ? 9.81 : std::numeric_limits<double>::quiet_NaN());
    mass.update(500, true, 0.01);
  }
  EXPECT_EQ(mass.mass_kg(), 2 * kDescribed_kg);
  mass.reset();
  EXPECT_EQ(mass.mass_kg(), kDescribed_kg);
}

}  // namespace
}  // namespace karst::core::test
