// The last resort, when something of the core has failed or the operator ends the flight: brake on what is
// left of the trajectory, fly the last known way to where the ground is fit to land on, and come straight
// down until the ground is felt. It needs no map and no policy, and once made, no memory.
#pragma once
#include <array>
#include <limits>
#include <span>

#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {

class EmergencyLanding {
 public:
  /// `limits` of the trajectories it will have to brake.
  EmergencyLanding(const MotionLimits& limits, double descent_mps);

  /// The way to above such ground from where the vehicle would stop, as long as no other is known: no more of
  /// it than kMaxPlaces is kept, and nothing of an empty one. Without a way it comes down where it stops.
  void prepare(std::span<const Vec3> path) noexcept;
  /// From `now` on; later calls change nothing. A way longer than `max_path_m` is not flown.
  void begin(const Trajectory& under_way, TimeNs now,
             double max_path_m = std::numeric_limits<double>::infinity()) noexcept;
  bool begun() const { return begun_; }
  /// What it was for is over: as if it had not begun, and no way were known.
  void break_off();
  /// What to follow at `now`, once it has begun.
  const Trajectory& trajectory(TimeNs now) const;

 private:
  static constexpr std::size_t kMaxPlaces = 64;
  void plan_move(TimeNs start, double max_path_m) noexcept;

  double deceleration_mps2_;
  std::size_t max_samples_;
  bool begun_ = false;
  std::array<Vec3, kMaxPlaces> path_{};
  std::size_t places_ = 0;
  Trajectory brake_, move_, descent_;
};

}  // namespace karst::core
