#include "core_stack/control/mpc_tracker.h"

#include <algorithm>

#include "core_stack/control/heading_tracker.h"
#include "core_stack/control/jerk_mpc.h"

namespace karst::core {
namespace {

// Limits hold softly: what is asked of the solver is less by this.
constexpr double kTightening = 0.985;
constexpr double kReachableMargin_s = 0.3;

JerkMpcSetup setup_of(const MpcOptions& o, const MotionLimits& limits) {
  JerkMpcSetup s;
  s.steps = static_cast<int>(o.steps);
  s.step_s = o.step_s;
  s.position_weight = o.position_weight;
  s.velocity_weight = o.velocity_weight;
  s.acceleration_weight = o.acceleration_weight;
  s.jerk_weight = o.jerk_weight;
  // They hold at the ends of the steps, too: between them speed is a parabola that rises by up to J dt^2 / 8,
  // whereas acceleration is linear and jerk constant.
  const double bulge_mps = limits.max_jerk_mps3 * o.step_s * o.step_s / 8;
  s.max_speed_mps = std::max(0.5 * limits.max_speed_mps, kTightening * limits.max_speed_mps - bulge_mps);
  s.max_acceleration_mps2 = kTightening * limits.max_acceleration_mps2;
  s.max_jerk_mps3 = kTightening * limits.max_jerk_mps3;
  return s;
}

}  // namespace

void describe(OptionTable& t, MpcOptions& o) {
  t.add("steps", o.steps, 5, 200, "prediction steps of the tracker");
  t.add("step", o.step_s, "s", 0.01, 0.5, "length of a prediction step");
  t.add("position_weight", o.position_weight, "", 1e-3, 1e6, "cost of the square of 1 m off the trajectory");
  t.add("velocity_weight", o.velocity_weight, "", 0, 1e6, "cost of the square of 1 m/s off its velocity");
  t.add("acceleration_weight", o.acceleration_weight, "", 0, 1e6, "cost of the square of 1 m/s^2");
  t.add("jerk_weight", o.jerk_weight, "", 1e-6, 1e6, "cost of the square of 1 m/s^3");
}

struct MpcTracker::Solver {
  Solver(const MpcOptions& options, const MotionLimits& limits)
      : mpc(setup_of(options, limits)),
        step(from_seconds(options.step_s)),
        targets(static_cast<std::size_t>(options.steps)),
        max_speed_mps(limits.max_speed_mps),
        heading_limits{limits.max_heading_rate_radps, limits.max_heading_acceleration_radps2} {}

  /// The sample at `t`, or the last good one where the trajectory has none.
  TrajectorySample target_at(const Trajectory& trajectory, TimeNs t) {
    if (trajectory.samples.empty()) return held;
    const TrajectorySample s = trajectory.at(t);
    return s.position.allFinite() && std::isfinite(s.heading_rad) ? s : held;
  }

  /// Moves the virtual vehicle along the plan, which holds each jerk for one step.
  void advance(TimeNs duration) {
    for (std::size_t k = 0; duration > 0; ++k) {
      const TimeNs part = std::min(duration, step);
      const Vec3 jerk = k < mpc.plan().jerk_mps3.size() ? mpc.plan().jerk_mps3[k] : Vec3::Zero();
      motion = advanced(motion, jerk, seconds(part));
      duration -= part;
    }
  }

  JerkMpc mpc;
  TimeNs step;
  std::vector<MotionTarget> targets;
  double max_speed_mps;
  HeadingLimits heading_limits;
  HeadingState heading;
  Motion motion;
  TrajectorySample held;
  Reference reference;
  bool warm = false;
};

MpcTracker::MpcTracker(const MpcOptions& options, const MotionLimits& limits)
    : solver_(std::make_unique<Solver>(options, limits)) {}
MpcTracker::~MpcTracker() = default;

void MpcTracker::reset(TimeNs now, const Vec3& position, double heading_rad) {
  Solver& s = *solver_;
  s.motion = {position, Vec3::Zero(), Vec3::Zero()};
  s.heading = {wrap_angle(heading_rad), 0};
  s.held = {position, heading_rad};
  s.reference = {now, position, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), s.heading.heading_rad, 0};
  s.warm = false;
}

const Reference& MpcTracker::step(const Trajectory& trajectory, TimeNs now) {
  Solver& s = *solver_;
  const TimeNs elapsed = now - s.reference.stamp;
  if (elapsed <= 0) return s.reference;
  const double dt = seconds(elapsed);
  if (s.warm) s.advance(elapsed);

  const TrajectorySample before = s.target_at(trajectory, now - elapsed);
  const TrajectorySample here = s.target_at(trajectory, now);
  s.heading = step_heading(s.heading, here.heading_rad,
                           wrap_angle(here.heading_rad - before.heading_rad) / dt, s.heading_limits, dt);
  s.held = here;
  // Velocities are central differences over one step: samples joined by straight lines have steps in
  // velocity.
  for (std::size_t k = 0; k < s.targets.size(); ++k) {
    const TimeNs t = now + s.step * static_cast<TimeNs>(k + 1);
    // A target out of reach is drawn in: it pulls the same way, with a force that keeps the problem well
    // scaled.
    const double reachable_m = s.max_speed_mps * (seconds(t - now) + kReachableMargin_s);
    const Vec3 offset = s.target_at(trajectory, t).position - s.motion.position;
    s.targets[k].position =
        s.motion.position + offset * std::min(1.0, reachable_m / std::max(offset.norm(), 1e-9));
    s.targets[k].velocity_mps = (s.target_at(trajectory, t + s.step / 2).position -
                                 s.target_at(trajectory, t - s.step / 2).position) /
                                seconds(s.step);
  }
  const JerkPlan& plan = s.mpc.solve(s.motion, s.targets, s.warm ? dt : -1.0);
  s.warm = true;
  s.reference = {now,
                 s.motion.position,
                 s.motion.velocity_mps,
                 s.motion.acceleration_mps2,
                 plan.jerk_mps3[0],
                 s.heading.heading_rad,
                 s.heading.rate_radps};
  return s.reference;
}

const Reference& MpcTracker::reference() const { return solver_->reference; }

}  // namespace karst::core
