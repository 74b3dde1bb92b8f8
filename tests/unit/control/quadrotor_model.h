// A small quadrotor for closed-loop tests: first-order response of body rates and thrust, drag against the
// air, gusts as an Ornstein-Uhlenbeck process. Own equations, independent of the simulator's.
#pragma once
#include <algorithm>
#include <cmath>

#include "core_stack/common/random.h"
#include "core_stack/localization/state.h"
#include "core_stack/vehicle/command.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core::test {

struct QuadrotorModel {
  double mass_kg = 2.0;
  double max_thrust_n = 45.0;
  double rate_lag_s = 0.03;
  double motor_lag_s = 0.04;
  double drag_per_s = 0.25;  // acceleration for each m/s of air speed
  double gust_mps = 0;       // standard deviation, each axis
  double gust_memory_s = 2.0;
  Vec3 steady_wind_mps = Vec3::Zero();
  Vec3 body_force_n = Vec3::Zero();  // such as motors that pull askew

  State state;
  double thrust_n = 2.0 * 9.81;
  Vec3 gust = Vec3::Zero();
  Vec3 specific_force_mps2{0, 0, 9.81};  // body frame, what an accelerometer feels
  Random random{7};

  void step(const AttitudeRateCommand& command, double dt) {
    const double keep = std::exp(-dt / gust_memory_s);
    const double kick = gust_mps * std::sqrt(1 - keep * keep);
    for (int i = 0; i < 3; ++i) gust[i] = keep * gust[i] + kick * random.normal();
    state.body_rate_radps +=
        (command.body_rate_radps - state.body_rate_radps) * (1 - std::exp(-dt / rate_lag_s));
    thrust_n +=
        (std::clamp(command.thrust_n, 0.0, max_thrust_n) - thrust_n) * (1 - std::exp(-dt / motor_lag_s));
    const Vec3 turn = state.body_rate_radps * dt;
    if (turn.norm() > 0)
      state.orientation =
          (state.orientation * Quat(Eigen::AngleAxisd(turn.norm(), turn.normalized()))).normalized();
    const Vec3 drag = -drag_per_s * (state.velocity_mps - steady_wind_mps - gust);
    const Vec3 force = state.orientation * (Vec3(0, 0, thrust_n) + body_force_n) / mass_kg + drag;
    specific_force_mps2 = state.orientation.conjugate() * force;
    state.velocity_mps += (force - Vec3(0, 0, 9.81)) * dt;
    state.position += state.velocity_mps * dt;
    state.stamp += from_seconds(dt);
  }
};

}  // namespace karst::core::test
