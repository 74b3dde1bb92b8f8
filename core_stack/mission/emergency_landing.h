// The last resort, when something of the core has failed or the operator ends the flight: brake on what is
// left of the trajectory, then come straight down until the ground is felt. It needs no map and no policy,
// and once made, no memory.
#pragma once
#include "core_stack/planning/trajectory.h"

namespace karst::core {

class EmergencyLanding {
 public:
  /// `limits` of the trajectories it will have to brake.
  EmergencyLanding(const MotionLimits& limits, double descent_mps);

  /// From `now` on; later calls change nothing.
  void begin(const Trajectory& under_way, TimeNs now) noexcept;
  bool begun() const { return begun_; }
  /// What to follow at `now`, once it has begun.
  const Trajectory& trajectory(TimeNs now) const;

 private:
  double deceleration_mps2_;
  std::size_t most_samples_;
  bool begun_ = false;
  Trajectory brake_, descent_;
};

}  // namespace karst::core
