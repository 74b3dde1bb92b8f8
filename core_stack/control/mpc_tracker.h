// Reference tracker: an MPC steers an ideal virtual vehicle along the trajectory, so that what the controller
// is asked to follow is always feasible: position, velocity, acceleration and jerk within limits, 100 Hz.
#pragma once
#include <memory>
#include <vector>

#include "core_stack/planning/trajectory/trajectory.h"
#include "core_stack/vehicle/command.h"

namespace karst::core {

struct MpcOptions {
  std::int64_t steps = 40;
  double step_s = 0.05;  // of the prediction, not of the output
  double position_weight = 100.0;
  double velocity_weight = 30.0;
  double acceleration_weight = 0.3;
  double jerk_weight = 0.1;
};
void describe(OptionTable& t, MpcOptions& o);

/// Speed, acceleration and jerk stay within `limits` as Euclidean norms, heading within its rate and
/// acceleration.
class MpcTracker {
 public:
  MpcTracker(const MpcOptions& options, const MotionLimits& limits);
  ~MpcTracker();
  /// The virtual vehicle stands at `position`.
  void reset(TimeNs now, const Vec3& position, double heading_rad);
  /// Advances the virtual vehicle to `now` (10 ms after the last call) along `trajectory`. Without samples,
  /// the last position asked for is held.
  const Reference& step(const Trajectory& trajectory, TimeNs now);
  const Reference& reference() const;

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace karst::core
