#include "plugins/simulator/dynamics/battery.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using sim::Battery;
using sim::BatteryOptions;
using sim::BodyModel;
using sim::MotorThrusts;

MotorThrusts hover() { return MotorThrusts::Constant(BodyModel{}.weight_n() / 4); }

TEST(Battery, HoverDrawsHoverPower) {
  const BatteryOptions o;
  EXPECT_NEAR(sim::power_w(o, {}, hover(), 0), o.hover_power_w, 1e-9);
}

TEST(Battery, PowerGrowsWithThrustToTheThreeHalves) {
  const BatteryOptions o;
  EXPECT_NEAR(sim::power_w(o, {}, 2 * hover(), 0),
              o.avionics_w + (o.hover_power_w - o.avionics_w) * std::pow(2, 1.5), 1e-9);
  EXPECT_EQ(sim::power_w(o, {}, MotorThrusts::Zero(), 3), o.avionics_w);
}

TEST(Battery, MotionCostsWhatDragTakes) {
  const BatteryOptions o;
  const BodyModel body;
  EXPECT_NEAR(sim::power_w(o, body, hover(), 4) - sim::power_w(o, body, hover(), 0),
              body.drag_kgps * 16 / 0.6, 1e-9);
}

TEST(Battery, HoversForTheMinutesItIsMadeFor) {
  BatteryOptions o;
  o.minutes = 10;
  Battery b(o);
  int steps = 0;
  for (; !b.empty(); ++steps) {
    if (steps % 10000 == 0) {
      // Energy left is capacity minus power times time; at a steady power the time left is exact.
      const auto s = b.status(0);
      EXPECT_NEAR(s.energy_left_wh, 50 - 300 * steps * 0.005 / 3600, 1e-6);
      EXPECT_NEAR(s.seconds_left, 600 - steps * 0.005, 1e-3);
    }
    b.drain(sim::power_w(o, {}, hover(), 0), 0.005, true);
  }
  EXPECT_NEAR(steps * 0.005, 600, 0.01);
  EXPECT_EQ(b.status(0).fraction_left, 0);
}

TEST(Battery, TimeLeftFollowsTheRecentMeanPowerOfFlight) {
  const BatteryOptions o;
  Battery b(o);
  for (int i = 0; i < 20 * 200; ++i) b.drain(450, 0.005, true);
  const auto s = b.status(0);
  const double mean = 300 + 150 * (1 - std::exp(-1.0));  // 20 s of memory
  EXPECT_NEAR(s.seconds_left, s.energy_left_wh * 3600 / mean, 1);
  EXPECT_EQ(s.power_w, 450);
}

TEST(Battery, StandingDoesNotPromiseALongerFlight) {
  const BatteryOptions o;
  Battery b(o);
  for (int i = 0; i < 60 * 200; ++i) b.drain(o.avionics_w, 0.005, false);
  EXPECT_NEAR(b.status(0).seconds_left, b.status(0).energy_left_wh * 3600 / o.hover_power_w, 1e-6);
}

}  // namespace
}  // namespace karst::test
