// The quadrotor: autopilot, motors, body, air, battery, and contact with the ground.
#pragma once
#include "plugins/simulator/dynamics/autopilot.h"
#include "plugins/simulator/dynamics/battery.h"
#include "plugins/simulator/dynamics/contact.h"
#include "plugins/simulator/dynamics/wind.h"

namespace karst::sim {

/// `standing`: carried by the ground. `leaving`: carried by thrust, but still in contact with the ground.
enum class Footing { standing, leaving, airborne };

enum class QuadrotorEvent { none, take_off, landed, crashed };

struct QuadrotorModel {
  BodyModel body;
  MotorModel motors;
  AutopilotOptions autopilot;
  BatteryOptions battery;
};

class Quadrotor {
 public:
  Quadrotor(const QuadrotorModel& model, const core::Pose& T_world_start, const cave::RayScene& scene,
            const Wind& wind);

  core::AttitudeRateCommand command;
  core::Vec3 gyroscope_bias_radps = core::Vec3::Zero();  // the autopilot flies by its biased gyroscope

  /// Replaces the rock around it from now on; `scene` must outlive its use.
  void put_into(const cave::RayScene& scene) { contact_.watch(scene); }

  /// Advances by `steps` of 1 ms; stops early at an event. Nothing moves after a crash.
  QuadrotorEvent advance(int steps);

  const BodyState& state() const { return state_; }
  Footing footing() const { return footing_; }
  const Battery& battery() const { return battery_; }
  core::Vec3 wind_mps() const { return wind_.velocity_mps(); }
  const std::optional<Touch>& last_touch() const { return last_touch_; }
  double clearance_m() { return contact_.clearance_m(state_.T_world_body.position); }
  long contact_queries() const { return contact_.queries(); }
  int steps_done() const { return steps_done_; }  // of the last advance()

 private:
  QuadrotorEvent step();
  QuadrotorEvent meet_rock(double lift_n);
  void level_out();

  QuadrotorModel model_;
  double max_motor_thrust_n_;
  BodyState state_;
  MotorThrusts motors_ = MotorThrusts::Zero();
  Footing footing_ = Footing::standing;
  Battery battery_;
  Wind wind_;
  ContactWatch contact_;
  std::optional<Touch> last_touch_;
  int steps_done_ = 0;
  long all_steps_ = 0;
};

}  // namespace karst::sim
