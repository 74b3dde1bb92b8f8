// The vehicle as a rigid body with six degrees of freedom in moving air.
#pragma once
#include "core_stack/common/geometry.h"
#include "core_stack/common/options.h"

namespace karst::sim {

constexpr double kGravity_mps2 = 9.81;

struct BodyModel {
  double mass_kg = 2.0;
  double payload_kg = 0;  // carried in addition, unknown to the core stack
  double radius_m = 0.3;  // of the vehicle's bounding sphere
  double roll_inertia_kgm2 = 0.02, pitch_inertia_kgm2 = 0.02, yaw_inertia_kgm2 = 0.036;
  double drag_kgps = 0.3;        // force = -drag * airspeed
  double spin_drag_nms = 0.004;  // torque = -spin_drag * body rate

  core::Vec3 inertia_kgm2() const { return {roll_inertia_kgm2, pitch_inertia_kgm2, yaw_inertia_kgm2}; }
  double weight_n() const { return mass_kg * kGravity_mps2; }  // as described
  double total_mass_kg() const { return mass_kg + payload_kg; }
  double total_weight_n() const { return total_mass_kg() * kGravity_mps2; }
};
void describe(core::OptionTable& t, BodyModel& m);

struct BodyState {
  core::Pose T_world_body;
  core::Vec3 velocity_mps = core::Vec3::Zero();     // world frame
  core::Vec3 body_rate_radps = core::Vec3::Zero();  // body frame
};

/// Wrench of the motors in the body frame: thrust along z, and torque.
struct Wrench {
  double thrust_n = 0;
  core::Vec3 torque_nm = core::Vec3::Zero();
};

/// One step of m v' = R f + m g - c (v - wind), J w' = torque - w x J w - d w, with the acceleration held
/// over the step: exact for constant force, first order otherwise, which suffices at 1 kHz.
BodyState advance(const BodyModel& model, const BodyState& s, const Wrench& wrench,
                  const core::Vec3& wind_mps, double dt_s);

}  // namespace karst::sim
