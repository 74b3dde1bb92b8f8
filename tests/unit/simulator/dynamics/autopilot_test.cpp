#include "plugins/simulator/dynamics/autopilot.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using sim::AutopilotOptions;
using sim::BodyModel;
using sim::BodyState;
using sim::MotorModel;
using sim::MotorThrusts;

/// A vehicle at 1.8 m/s whose autopilot brings it down for `duration_s`, in air without drag.
BodyState descended(double duration_s, bool knows_velocity) {
  BodyModel body;
  body.spin_drag_nms = 0;
  const MotorModel motors;
  BodyState s;
  s.velocity_mps = {1.8, 0, 0};
  MotorThrusts f = MotorThrusts::Constant(body.weight_n() / 4);
  for (double t = 0; t < duration_s; t += 0.001) {
    const auto command = sim::level_descent(
        s, body.weight_n(), knows_velocity ? std::optional(s.velocity_mps) : std::nullopt, 0.5);
    const sim::Wrench w = sim::rate_control({}, body, command, s.body_rate_radps);
    f = sim::follow(motors, f, sim::mix(motors, sim::max_motor_thrust_n(motors, body), w), 0.001);
    s = sim::advance(body, s, sim::wrench_of(motors, f), Vec3::Zero(), 0.001);
  }
  return s;
}

// It flew on at that speed until it touched rock, whenever the core stood still for long.
TEST(Autopilot, ThatKnowsItsVelocityBrakesWhenNoMoreCommandsCome) {
  const BodyState braked = descended(4, true);
  EXPECT_LT(braked.velocity_mps.head<2>().norm(), 0.1);
  EXPECT_LT(braked.T_world_body.position.head<2>().norm(), 2.5);
  EXPECT_NEAR(braked.velocity_mps.z(), -0.5, 0.05);
  EXPECT_GT((braked.T_world_body.orientation * Vec3::UnitZ()).z(), 0.99);
  EXPECT_GT(descended(4, false).T_world_body.position.x(), 5) << "it drifts, as it knows no velocity";
}

/// Autopilot, motors and body in free space.
std::vector<Vec3> rates_after_step(const Vec3& commanded, int steps) {
  const AutopilotOptions o;
  BodyModel body;
  body.spin_drag_nms = 0;
  const MotorModel motors;
  BodyState s;
  MotorThrusts f = MotorThrusts::Constant(body.weight_n() / 4);
  std::vector<Vec3> rates;
  for (int i = 0; i < steps; ++i) {
    const sim::Wrench w = sim::rate_control(o, body, {commanded, body.weight_n(), true}, s.body_rate_radps);
    f = sim::follow(motors, f, sim::mix(motors, sim::max_motor_thrust_n(motors, body), w), 0.001);
    s = sim::advance(body, s, sim::wrench_of(motors, f), Vec3::Zero(), 0.001);
    rates.push_back(s.body_rate_radps);
  }
  return rates;
}

TEST(Autopilot, RateStepIsTheSecondOrderResponseOfGainAndLag) {
  // tau s^2 + s + k = 0: natural frequency sqrt(k / tau), damping 1 / (2 sqrt(k tau)).
  const double k = AutopilotOptions{}.rate_gain_1ps, tau = MotorModel{}.time_constant_s;
  const double wn = std::sqrt(k / tau), zeta = 1 / (2 * std::sqrt(k * tau)),
               wd = wn * std::sqrt(1 - zeta * zeta);
  const auto rates = rates_after_step({0.5, 0, 0}, 400);
  for (const int i : {20, 50, 100, 200, 400}) {
    const double t = i * 0.001;
    const double expected =
        0.5 * (1 - std::exp(-zeta * wn * t) *
                       (std::cos(wd * t) + zeta / std::sqrt(1 - zeta * zeta) * std::sin(wd * t)));
    EXPECT_NEAR(rates[static_cast<std::size_t>(i - 1)].x(), expected, 0.01) << i << " ms";
  }
}

TEST(Autopilot, ReachesEachCommandedRate) {
  for (const Vec3& w : {Vec3(1, 0, 0), Vec3(0, -2, 0), Vec3(0, 0, 1.5), Vec3(0.5, 0.5, -0.5)})
    EXPECT_LT((rates_after_step(w, 2000).back() - w).norm(), 0.02) << w.transpose();
}

TEST(Autopilot, LimitsCommandedRates) {
  EXPECT_LT(rates_after_step({50, 0, 0}, 1500).back().x(), AutopilotOptions{}.max_body_rate_radps + 0.05);
}

TEST(Autopilot, DisarmedOrNotFiniteCommandsGiveNoThrust) {
  const AutopilotOptions o;
  const BodyModel b;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(sim::rate_control(o, b, {Vec3::Zero(), 20, false}, Vec3::Zero()).thrust_n, 0);
  EXPECT_EQ(sim::rate_control(o, b, {Vec3::Zero(), nan, true}, Vec3::Zero()).thrust_n, 0);
  EXPECT_EQ(sim::rate_control(o, b, {Vec3(0, nan, 0), 20, true}, Vec3::Zero()).thrust_n, 0);
  EXPECT_EQ(sim::rate_control(o, b, {Vec3::Zero(), -5, true}, Vec3::Zero()).thrust_n, 0);
}

}  // namespace
}  // namespace karst::test
