// The last resort when a part of the core has failed or the operator ends the flight: brakes along the
// remaining trajectory, flies the last known path to ground suitable for landing, and descends vertically
// until ground contact. It needs no map and no policy and, once constructed, allocates no memory.
#pragma once
#include <array>
#include <limits>
#include <span>

#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {

class EmergencyLanding {
 public:
  /// `limits`: of the trajectories that it may have to brake.
  EmergencyLanding(const MotionLimits& limits, double descent_mps);

  /// Sets the path from the expected stop to above such ground (world frame), until the next call. At most
  /// kMaxPlaces points are kept; an empty path clears it. Without a path the vehicle descends where it stops.
  void prepare(std::span<const Vec3> path) noexcept;
  /// Starts at `now`; later calls have no effect. A path longer than `max_path_m` is not flown.
  void begin(const Trajectory& under_way, TimeNs now,
             double max_path_m = std::numeric_limits<double>::infinity()) noexcept;
  bool begun() const { return begun_; }
  /// Cancels the landing: afterwards it has not begun, and no path is known.
  void break_off();
  /// The trajectory to follow at `now`; only after begin().
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
