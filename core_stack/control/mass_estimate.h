// Estimates the vehicle's mass in flight: with a payload or another battery than described, the same
// acceleration needs another thrust.
#pragma once
#include "core_stack/common/time.h"

namespace karst::core {

/// In the air, thrust = mass * specific force along the body's z axis, but for drag, which averages out.
class MassEstimate {
 public:
  explicit MassEstimate(double described_kg);
  /// Back to what was described: before a take-off.
  void reset();
  /// Body z component of an accelerometer sample, m/s^2.
  void on_specific_force(double up_mps2);
  /// `thrust_n`: commanded over the last `dt_s`. Learns while `airborne`; on the ground its reaction force
  /// cannot be told from thrust.
  void update(double thrust_n, bool airborne, double dt_s);
  double mass_kg() const { return mass_kg_; }

 private:
  double described_kg_, mass_kg_;
  double sample_sum_mps2_ = 0;
  int samples_ = 0;
  double thrust_n_ = 0, force_mps2_ = 0;  // both with the same lag, which outweighs the motors' own
  double airborne_s_ = 0;
};

}  // namespace karst::core
