// Trajectory sampling: from a path to positions and headings at a fixed rate, slow where it bends
// (section III-C of the paper; the unit slip in its a_k is resolved in docs/planning.md).
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/options.h"
#include "core_stack/common/time.h"
#include "core_stack/planning/trajectory/speed_by_trust.h"
#include "core_stack/planning/trajectory/trajectory_kind.h"

namespace karst::core {

struct MotionLimits {
  double max_speed_mps = 2.0;
  double min_speed_mps = 0.3;  // v_min of the sampling: floor in bends
  double max_acceleration_mps2 = 2.0;
  double max_jerk_mps3 = 12.0;
  double max_heading_rate_radps = 1.0;
  double max_heading_acceleration_radps2 = 2.0;
  TrajectoryKind trajectory = TrajectoryKind::horizon;
  bool operator==(const MotionLimits&) const = default;
};
void describe(OptionTable& t, MotionLimits& o);

/// Places near which flight is slower, within `radius_m`; and what else limits the speed by place.
struct SlowPlaces {
  std::vector<Vec3> places;
  double radius_m = 1.0;
  double speed_mps = 1.0;
  TrustedSpeeds trusted = {};  // along the path
};

struct TrajectorySample {
  Vec3 position = Vec3::Zero();
  double heading_rad = 0;
  SpeedLimit limited_by = SpeedLimit::none;
};

/// Samples at `period` from `start`, clamped to the first sample before and the last one after.
struct Trajectory {
  TimeNs start = 0;
  TimeNs period = 100 * kMillisecond;
  std::vector<TrajectorySample> samples;

  TrajectorySample at(TimeNs t) const;  // linear between samples, heading along the shorter arc
  TimeNs end() const {
    return start + period * static_cast<TimeNs>(samples.empty() ? 0 : samples.size() - 1);
  }
};

/// A place on the path, and where to look when passing it.
struct PassingLook {
  Vec3 place = Vec3::Zero();
  double heading_rad = 0;
};

struct HeadingPlan {
  bool along_path = true;  // face the direction of flight
  double start_heading_rad = 0;
  std::optional<PassingLook> passing;
  std::optional<double> goal_heading_rad;  // reached over the last stretch and at the goal
};

/// The greatest speed at the beginning of a path from which the vehicle can slow down for each bend and for
/// the end, m/s. The acceleration that a bend takes is not there for braking. If the vehicle begins faster,
/// its reference leaves the path.
double greatest_start_speed_mps(const std::vector<Vec3>& points, const MotionLimits& limits);

/// Samples `points` from `start_speed_mps` along the path to rest at its end. Accelerations along and across
/// the path stay within the limits (up to sampling). The vehicle turns on the spot first where it must face
/// the direction of flight and the path turns faster than the heading rate allows. A path that takes longer
/// than two hours is cut: the trajectory then ends at rest on the path before that.
Trajectory sample_trajectory(const std::vector<Vec3>& points, double start_speed_mps, TimeNs start,
                             const MotionLimits& limits, const HeadingPlan& heading,
                             const SlowPlaces& slow = {});

}  // namespace karst::core
