// The inner loop: state estimate, trajectory, MPC reference, SE(3) command. Positions are in the world frame.
#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "core_stack/control/mass_estimate.h"
#include "core_stack/control/mpc_tracker.h"
#include "core_stack/control/se3_controller.h"
#include "core_stack/localization/estimator.h"
#include "core_stack/mission/flight/emergency_landing.h"
#include "core_stack/mission/options/mission_options.h"
#include "core_stack/planning/horizon/rollout.h"
#include "core_stack/planning/trajectory/minimum_snap.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// A path and how it is to be flown.
struct Course {
  std::vector<Vec3> points;  // the first is the reference position at `start`
  double start_speed_mps = 0;
  TimeNs start = 0;  // not before now
  HeadingPlan heading = {};
  std::optional<double> max_speed_mps = {};  // its own speed limit, within the mission's
  SlowPlaces slow = {};
};

/// The limits of a path that may have a speed limit of its own.
MotionLimits slowed(MotionLimits limits, std::optional<double> max_speed_mps);

/// The angle to turn when looking around: a full turn less the widest camera's view, with a little overlap.
double turn_to_see_all_around(const VehicleDescription& vehicle);

/// Fraction of a path's acceleration used for braking distances; the rest is for tracking.
constexpr double kBrakingFraction = 0.8;

/// The limits of paths, below the tracker's own. If trajectories were sampled at those, the virtual vehicle
/// could never catch up after a delay: it would fall ever further behind, and cut corners.
MotionLimits with_room_to_catch_up(MotionLimits limits);

class Flight {
 public:
  Flight(const CoreOptions& options, const VehicleDescription& vehicle);

  /// `now`: when the sample came; over a link that is later than its stamp.
  void on_imu(const ImuSample& s, TimeNs now) {
    const TimeNs before = estimator_.last_imu();
    estimator_.on_imu(s);
    if (estimator_.last_imu() > before) {
      imu_came_ = now;
      imu_lag_ = now - s.stamp;
    }
    mass_.on_specific_force(s.specific_force_mps2.z());
  }
  /// Nobody measured for a while what the vehicle did.
  void lose_track() { estimator_.lose_track(); }
  void on_pose(const PoseSample& s) { estimator_.on_pose(s); }
  /// Returns false if the estimator refuses the pose.
  bool on_lidar_pose(const PoseMeasurement& p) { return estimator_.on_lidar_pose(p); }
  void on_barometer(const BarometerSample& s) { estimator_.on_barometer(s); }
  void on_magnetometer(const MagnetometerSample& s) { estimator_.on_magnetometer(s); }

  /// One control cycle, every 10 ms. Disarmed until the first `follow` or `climb`.
  Command control(TimeNs now);

  void follow(const Course& course);
  /// Follows a trajectory along the path that was prepared beforehand on the map lane.
  void follow(const Course& course, Trajectory ready);
  /// The limits that `follow` observes.
  MotionLimits limits(std::optional<double> max_speed_mps = std::nullopt) const;
  /// The same for plans that begin at the reference.
  MotionLimits limits_of_plans(std::optional<double> max_speed_mps = std::nullopt) const;
  /// Limits the speed from now on, also along the rest of the current path.
  void cap_speed(TimeNs now, double max_speed_mps);
  /// Climbs (or descends, if negative) vertically by `height_m` at `speed_mps` from the current reference.
  void climb(TimeNs now, double height_m, double speed_mps);
  /// Turns on the spot by `turn_rad`, so that a camera sees its surroundings.
  void look_around(TimeNs now, double turn_rad);
  /// Stops, as hard as the limits allow, along the current trajectory, which is known to be free.
  void brake(TimeNs now);
  /// Sets the path from the expected stop to a landing site, for land_now().
  void prepare_landing(std::span<const Vec3> path) noexcept { emergency_landing_.prepare(path); }
  /// Brakes, flies that path unless it is longer than `max_path_m`, and descends vertically. Ignores all
  /// later commands. Allocates no memory.
  void land_now(TimeNs now, double max_path_m = std::numeric_limits<double>::infinity()) noexcept;
  /// Hovers where it is, whatever it followed before, also a landing.
  void hover_here(TimeNs now);
  /// Another steers: the commands are those of a hover, and change nothing in the controllers.
  void let_go() noexcept { steers_ = false; }
  /// Steers again, or for the first time in the air, from a hover where it is.
  void take_over(TimeNs now);
  /// As before the first take-off; only on the ground.
  void stand_down() noexcept;
  /// Switches the motors off for good; only on the ground.
  void disarm() noexcept;

  /// The part of the trajectory from `t` on to which the vehicle is committed, for planning ahead.
  struct CommittedSegment {
    std::vector<Vec3> points;  // from the position at t to the start of a possible new path; at least one
    double speed_mps = 0;      // at t
    double heading_rad = 0;    // at t
    Departure departure;       // at t: the velocity and acceleration, for polynomials
  };
  /// Up to the point at which the vehicle could stop.
  CommittedSegment until_stop(TimeNs t) const;
  /// Up to the trajectory's end.
  CommittedSegment until_end(TimeNs t) const;

  bool airborne() const { return motors_ == Motors::armed; }
  bool at_rest(TimeNs now) const { return now >= trajectory_end(); }
  TimeNs trajectory_end() const { return trajectory_.end(); }
  /// The state on the trajectory at `t`, with level attitude.
  State expected(TimeNs t) const;
  /// Where the vehicle will be at `t`, a moment from now, for planning on from there in motion. This is not
  /// the trajectory: the reference lags behind it where it bends.
  MotionState motion_at(TimeNs t) const;
  /// The trajectory from `t` to its end, every 100 ms.
  std::vector<TrajectorySample> samples_from(TimeNs t) const;
  /// What sets the speed along the trajectory.
  SpeedLimit speed_limit(TimeNs now) const {
    return at_rest(now) || braking_ ? SpeedLimit::none : trajectory_.at(now).limited_by;
  }
  /// The deceleration of planned stops.
  double braking_mps2() const { return kBrakingFraction * limits_.max_acceleration_mps2; }
  /// Time at which the trajectory is nearest to `p`.
  TimeNs time_nearest(const Vec3& p) const;
  double remaining_s(TimeNs now) const { return seconds(std::max<TimeNs>(0, trajectory_.end() - now)); }
  const State& state() const { return estimator_.state(); }
  const Estimator& estimator() const { return estimator_; }
  const Reference& reference() const { return tracker_.reference(); }
  double mass_kg() const { return mass_.mass_kg(); }

 private:
  CommittedSegment committed_segment(TimeNs t, double length_m) const;
  Vec3 velocity_at(TimeNs t) const;
  void bridge(TimeNs until);
  Command command(TimeNs now) const;
  void arm(TimeNs now);
  Departure departure_at(TimeNs t) const;

  MotionLimits tracked_, limits_, emergency_;  // of the tracker, for paths, and for braking
  Estimator estimator_;
  MpcTracker tracker_;
  Se3Controller controller_;
  MassEstimate mass_;
  bool takes_reference_;
  AttitudeRateCommand command_;
  double ground_m_ = 0;  // height of the vehicle's centre before take-off
  Trajectory trajectory_;
  HeadingPlan heading_;  // of the current path, like its own speed limit and its slow places
  SlowPlaces slow_;
  std::optional<double> path_speed_mps_;
  double speed_cap_mps_ = std::numeric_limits<double>::infinity();
  EmergencyLanding emergency_landing_;
  enum class Motors { idle, armed, off } motors_ = Motors::idle;  // off: the motors never run again
  bool braking_ = false;                                          // a braking trajectory is never slowed down
  TimeNs imu_came_ = 0, imu_lag_ = 0;                             // of the newest sample
  bool steers_ = true;                                            // false: another does
};

}  // namespace karst::core
