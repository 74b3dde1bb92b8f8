#include "core_stack/mission/flight/flight.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace karst::core {
namespace {

constexpr double kControlPeriod_s = 0.01;
constexpr double kOffGround_m = 0.15, kGravity_mps2 = 9.81;
constexpr TimeNs kImuMissed = 25 * kMillisecond;  // without a sample: then predicted samples replace the IMU

/// No later motion depends on a brake's timing, so it may use nearly the full acceleration.
constexpr double kEmergencyFraction = 0.95;

/// Fraction of the maximal heading rate while looking around; the rest makes up for the acceleration phase.
constexpr double kTurningFraction = 0.9;

/// A plan with a receding horizon begins where the reference is: there is no delay to catch up. The tracker
/// keeps a little below its limits.
constexpr double kPlannedSpeedFraction = 0.98, kPlannedAccelerationFraction = 0.9;

}  // namespace

MotionLimits with_room_to_catch_up(MotionLimits limits) {
  limits.max_speed_mps *= 0.93;
  limits.max_acceleration_mps2 *= 0.75;
  limits.min_speed_mps = std::min(limits.min_speed_mps, limits.max_speed_mps);
  return limits;
}

MotionLimits slowed(MotionLimits limits, std::optional<double> max_speed_mps) {
  if (max_speed_mps) limits.max_speed_mps = std::min(limits.max_speed_mps, *max_speed_mps);
  limits.min_speed_mps = std::min(limits.min_speed_mps, limits.max_speed_mps);
  return limits;
}

Flight::Flight(const CoreOptions& options, const VehicleDescription& vehicle)
    : tracked_(options.motion),
      limits_(with_room_to_catch_up(options.motion)),
      emergency_(limits_),
      estimator_(options.localization.estimator, vehicle.T_world_start),
      tracker_(options.tracker, options.motion),
      controller_(options.controller, vehicle.mass_kg, vehicle.max_thrust_n, vehicle.max_body_rate_radps),
      mass_(vehicle.mass_kg),
      takes_reference_(vehicle.takes_reference),
      emergency_landing_(options.motion, options.mission.landing_speed_mps) {
  emergency_.max_acceleration_mps2 = kEmergencyFraction * options.motion.max_acceleration_mps2;
  const Pose& start = vehicle.T_world_start;
  ground_m_ = start.position.z();
  trajectory_.samples = {{start.position, heading_of(start.orientation)}};
  tracker_.reset(0, start.position, heading_of(start.orientation));
}

Command Flight::command(TimeNs now) const {
  const bool known = estimator_.health(now) != Health::lost && !estimator_.guesses();
  return {command_, tracker_.reference(), state(), known};
}

Command Flight::control(TimeNs now) {
  if (motors_ == Motors::off || (motors_ == Motors::idle && steers_)) {
    command_ = {};
    return command(now);
  }
  // Up to the time that the IMU would tell of by now: samples that come late are not to come too late.
  if (now - imu_came_ > kImuMissed) bridge(now - imu_lag_);
  if (!steers_) {
    command_ = {Vec3::Zero(), mass_.mass_kg() * kGravity_mps2, true};
    return command(now);
  }
  if (!takes_reference_) {
    mass_.update(command_.thrust_n, state().position.z() > ground_m_ + kOffGround_m, kControlPeriod_s);
    controller_.set_mass_kg(mass_.mass_kg());
  }
  const Trajectory& wanted = emergency_landing_.begun() ? emergency_landing_.trajectory(now) : trajectory_;
  command_ = controller_.update(state(), tracker_.step(wanted, now), kControlPeriod_s);
  command_.armed = true;
  return command(now);
}

/// With the IMU measurement expected if the vehicle follows its commands. What controllers of its own do,
/// nobody knows here: the thrust and the rates of this side were flown by nobody.
void Flight::bridge(TimeNs until) {
  using Expected = Estimator::Expected;
  if (steers_ && !takes_reference_)
    estimator_.bridge({until, Vec3(0, 0, command_.thrust_n / mass_.mass_kg()), command_.body_rate_radps},
                      Expected::as_commanded);
  else
    estimator_.bridge({until, Vec3(0, 0, kGravity_mps2), Vec3::Zero()}, Expected::another_steers);
}

void Flight::follow(const Course& c) {
  follow(c,
         sample_trajectory(c.points, c.start_speed_mps, c.start, limits(c.max_speed_mps), c.heading, c.slow));
}

void Flight::follow(const Course& course, Trajectory ready) {
  SlowPlaces slow = course.slow;  // the only copy that takes memory: without it, all stays as it was
  slow_ = std::move(slow);
  heading_ = course.heading;
  path_speed_mps_ = course.max_speed_mps;
  braking_ = false;
  trajectory_ = std::move(ready);
}

MotionLimits Flight::limits(std::optional<double> max_speed_mps) const {
  MotionLimits limits = limits_;
  limits.max_speed_mps = std::min(limits.max_speed_mps, speed_cap_mps_);
  return slowed(limits, max_speed_mps);
}

MotionLimits Flight::limits_of_plans(std::optional<double> max_speed_mps) const {
  MotionLimits limits = tracked_;
  limits.max_speed_mps = std::min(kPlannedSpeedFraction * limits.max_speed_mps, speed_cap_mps_);
  limits.max_acceleration_mps2 *= kPlannedAccelerationFraction;
  return slowed(limits, max_speed_mps);
}

void Flight::cap_speed(TimeNs now, double max_speed_mps) {
  if (max_speed_mps == speed_cap_mps_) return;
  speed_cap_mps_ = max_speed_mps;
  if (at_rest(now) || braking_) return;
  const CommittedSegment left = until_end(now);
  HeadingPlan heading = heading_;
  heading.start_heading_rad = left.heading_rad;
  follow({.points = left.points,
          .start_speed_mps = left.speed_mps,
          .start = now,
          .heading = heading,
          .max_speed_mps = path_speed_mps_,
          .slow = slow_});
}

TimeNs Flight::time_nearest(const Vec3& p) const {
  const auto& samples = trajectory_.samples;
  const auto nearest = std::min_element(samples.begin(), samples.end(), [&](const auto& a, const auto& b) {
    return (a.position - p).squaredNorm() < (b.position - p).squaredNorm();
  });
  return trajectory_.start + trajectory_.period * static_cast<TimeNs>(nearest - samples.begin());
}

/// Begins from the estimate: it has converged at rest, and the declared pose may differ.
void Flight::arm(TimeNs now) {
  tracker_.reset(now, state().position, heading_of(state().orientation));
  controller_.reset();
  mass_.reset();
  motors_ = Motors::armed;
}

void Flight::take_over(TimeNs now) {
  if (motors_ == Motors::off) return;
  if (motors_ == Motors::idle) arm(now);
  controller_.reset();
  hover_here(now);
  steers_ = true;
}

void Flight::climb(TimeNs now, double height_m, double speed_mps) {
  if (motors_ == Motors::off) return;
  if (motors_ == Motors::idle) {
    ground_m_ = state().position.z();
    arm(now);
  }
  const Vec3 from = reference().position;
  MotionLimits slow = limits_;
  slow.max_speed_mps = speed_mps;
  slow.min_speed_mps = std::min(limits_.min_speed_mps, speed_mps);
  HeadingPlan keep;
  keep.along_path = false;
  keep.start_heading_rad = reference().heading_rad;
  trajectory_ = sample_trajectory({from, from + Vec3(0, 0, height_m)}, 0, now, slow, keep);
}

double turn_to_see_all_around(const VehicleDescription& vehicle) {
  constexpr double kOverlap_rad = 0.2;
  double seen_rad = 0;
  for (const auto& camera : vehicle.cameras) seen_rad = std::max(seen_rad, camera->horizontal_fov_rad);
  return std::max(0.0, 2 * std::numbers::pi - std::max(0.0, seen_rad - kOverlap_rad));
}

void Flight::look_around(TimeNs now, double turn_rad) {
  const Vec3 here = reference().position;
  const double heading = reference().heading_rad;
  const double rate = kTurningFraction * limits_.max_heading_rate_radps;
  Trajectory turn;
  turn.start = now;
  const int steps = static_cast<int>(std::ceil(turn_rad / (rate * seconds(turn.period))));
  for (int i = 0; i <= steps; ++i)
    turn.samples.push_back({here, wrap_angle(heading + turn_rad * i / std::max(1, steps))});
  trajectory_ = std::move(turn);
}

void Flight::brake(TimeNs now) {
  const double v = velocity_at(now).norm();
  const CommittedSegment stop = committed_segment(now, v * v / (2 * emergency_.max_acceleration_mps2));
  HeadingPlan keep;
  keep.along_path = false;
  keep.start_heading_rad = stop.heading_rad;
  trajectory_ = sample_trajectory(stop.points, stop.speed_mps, now, emergency_, keep);
  braking_ = true;
}

void Flight::land_now(TimeNs now, double max_path_m) noexcept {
  emergency_landing_.begin(trajectory_, now, max_path_m);
}

/// At the current state, and not at the reference: a newly found pose may place that elsewhere.
void Flight::hover_here(TimeNs now) {
  const TrajectorySample here{state().position, heading_of(state().orientation)};
  Trajectory hover;
  hover.start = now;
  hover.samples = {here};
  emergency_landing_.break_off();
  trajectory_ = std::move(hover);
  tracker_.reset(now, here.position, here.heading_rad);
}

void Flight::stand_down() noexcept {
  if (motors_ == Motors::armed) motors_ = Motors::idle;
  trajectory_.samples.resize(1);
  steers_ = true;
}

void Flight::disarm() noexcept {
  motors_ = Motors::off;
  trajectory_.samples.resize(1);
}

Vec3 Flight::velocity_at(TimeNs t) const {
  constexpr TimeNs dt = 50 * kMillisecond;
  return (trajectory_.at(t + dt).position - trajectory_.at(t).position) / seconds(dt);
}

Departure Flight::departure_at(TimeNs t) const {
  const TimeNs period = trajectory_.period;
  const Vec3 before = trajectory_.at(t - period).position, here = trajectory_.at(t).position,
             after = trajectory_.at(t + period).position;
  const double dt = seconds(period);
  return {(after - before) / (2 * dt), (after - 2 * here + before) / (dt * dt)};
}

State Flight::expected(TimeNs t) const {
  const TrajectorySample sample = trajectory_.at(t);
  return {t, sample.position, velocity_at(t), from_heading(sample.heading_rad), Vec3::Zero()};
}

MotionState Flight::motion_at(TimeNs t) const {
  const Reference& r = reference();
  const double dt = seconds(t - r.stamp);
  return {r.position + dt * r.velocity_mps + 0.5 * dt * dt * r.acceleration_mps2,
          r.velocity_mps + dt * r.acceleration_mps2, r.acceleration_mps2,
          wrap_angle(r.heading_rad + dt * r.heading_rate_radps), r.heading_rate_radps};
}

std::vector<TrajectorySample> Flight::samples_from(TimeNs t) const {
  std::vector<TrajectorySample> out{trajectory_.at(t)};
  for (TimeNs at = t; at < trajectory_.end();) out.push_back(trajectory_.at(at += trajectory_.period));
  return out;
}

Flight::CommittedSegment Flight::committed_segment(TimeNs t, double length_m) const {
  CommittedSegment out{
      {trajectory_.at(t).position}, velocity_at(t).norm(), trajectory_.at(t).heading_rad, departure_at(t)};
  double length = 0;
  for (std::size_t i = 0; i < trajectory_.samples.size() && length < length_m; ++i) {
    if (trajectory_.start + trajectory_.period * static_cast<TimeNs>(i) <= t) continue;
    const Vec3& next = trajectory_.samples[i].position;
    const double step = (next - out.points.back()).norm();
    if (step < 1e-6) continue;
    length += step;
    out.points.push_back(next);
  }
  return out;
}

/// The acceleration falls to that of braking at the greatest jerk: x = v T + a T^2 / 2 - j T^3 / 6 until
/// then, or until the vehicle stands.
Flight::CommittedSegment Flight::until_stop(TimeNs t) const {
  const double v = velocity_at(t).norm(), braking = braking_mps2(), jerk = limits_.max_jerk_mps3;
  if (v < 1e-3) return committed_segment(t, 0);
  const double a = std::clamp(departure_at(t).acceleration_mps2.dot(velocity_at(t)) / v, -braking,
                              limits_.max_acceleration_mps2);
  const double brakes_s = (a + braking) / jerk, stands_s = (a + std::sqrt(a * a + 2 * jerk * v)) / jerk;
  const double T = std::min(brakes_s, stands_s), then_mps = std::max(0.0, v + a * T - jerk * T * T / 2);
  return committed_segment(
      t, v * T + a * T * T / 2 - jerk * T * T * T / 6 + then_mps * then_mps / (2 * braking));
}

Flight::CommittedSegment Flight::until_end(TimeNs t) const {
  return committed_segment(t, std::numeric_limits<double>::infinity());
}

}  // namespace karst::core
