#include "plugins/simulator/dynamics/rigid_body.h"

namespace karst::sim {

using core::Quat;
using core::Vec3;

void describe(core::OptionTable& t, BodyModel& m) {
  t.add("mass", m.mass_kg, "kg", 0.2, 20, "take-off mass");
  t.add("payload", m.payload_kg, "kg", 0, 20, "carried besides, and not told to the core stack");
  t.add("radius", m.radius_m, "m", 0.05, 2, "of the sphere that holds the vehicle with its propellers");
  t.add("roll_inertia", m.roll_inertia_kgm2, "kg m^2", 1e-4, 5, "moment of inertia about the forward axis");
  t.add("pitch_inertia", m.pitch_inertia_kgm2, "kg m^2", 1e-4, 5, "moment of inertia about the left axis");
  t.add("yaw_inertia", m.yaw_inertia_kgm2, "kg m^2", 1e-4, 5, "moment of inertia about the upward axis");
  t.add("drag", m.drag_kgps, "kg/s", 0, 10, "drag force over airspeed");
  t.add("spin_drag", m.spin_drag_nms, "N m s", 0, 1, "drag torque over body rate");
}

BodyState advance(const BodyModel& model, const BodyState& s, const Wrench& wrench, const Vec3& wind_mps,
                  double dt_s) {
  const Quat& R = s.T_world_body.orientation;
  const Vec3 force_n = R * Vec3(0, 0, wrench.thrust_n) - model.drag_kgps * (s.velocity_mps - wind_mps);
  const Vec3 acceleration = force_n / model.total_mass_kg() - Vec3(0, 0, kGravity_mps2);

  const Vec3 J = model.inertia_kgm2();
  const Vec3& w = s.body_rate_radps;
  const Vec3 torque = wrench.torque_nm - w.cross(J.cwiseProduct(w)) - model.spin_drag_nms * w;

  BodyState next;
  next.velocity_mps = s.velocity_mps + acceleration * dt_s;
  next.T_world_body.position =
      s.T_world_body.position + s.velocity_mps * dt_s + acceleration * (0.5 * dt_s * dt_s);
  next.body_rate_radps = w + torque.cwiseQuotient(J) * dt_s;
  // Half the rotation vector; at 1 kHz its sine is itself to 1e-8.
  const Vec3 half = (w + next.body_rate_radps) * (0.25 * dt_s);
  next.T_world_body.orientation = (R * Quat(1.0, half.x(), half.y(), half.z())).normalized();
  return next;
}

}  // namespace karst::sim
