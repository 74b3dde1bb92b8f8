#include "core_stack/mission/phases/steering.h"

#include <algorithm>

namespace karst::core {
namespace {

/// Of two scans at 10 Hz, less what their times may vary by.
constexpr TimeNs kSteeringPeriod = 180 * kMillisecond, kBudget = 60 * kMillisecond;
/// Longer than between scans of which three in four are left out.
constexpr TimeNs kScansStayAway = 500 * kMillisecond;
constexpr double kSame_m = 0.01;
/// A plan that begins farther from where the vehicle is by then is not flown: it would cut a corner.
constexpr double kOff_m = 0.05, kOff_mps = 0.25;
/// A goal may be this much later than first expected for what is seen on the way.
constexpr double kLater = 1.5, kLater_s = 3.0;

/// The legs from `since` after their begin on.
Legs moved_on(const Legs& legs, TimeNs since) {
  Legs out;
  for (int i = 0; i < kLegs; ++i) {
    const auto k = static_cast<int>((since + i * kLeg + kLeg / 2) / kLeg);
    out[static_cast<std::size_t>(i)] = legs[static_cast<std::size_t>(std::clamp(k, 0, kLegs - 1))];
  }
  return out;
}

}  // namespace

bool Steering::applies() const {
  const PathExecution& path = parts_.path;
  return onboard_.options.motion.trajectory == TrajectoryKind::horizon && parts_.phases.in(Phase::explore) &&
         parts_.goals.goal() && !path.blocked() && !path.held() && !path.yields() && !path.detour_due() &&
         path.narrow_places().empty();
}

/// With a LiDAR scans begin the plans. Were they begun by images, some scans would wait a period longer until
/// they change the course.
bool Steering::begins_plans(SeenWith sensor) const {
  return sensor == SeenWith::lidar || !onboard_.vehicle.lidar || onboard_.now() - last_scan_ > kScansStayAway;
}

void Steering::on_map(SeenWith sensor) {
  const TimeNs now = onboard_.now();
  note_goal();
  if (sensor == SeenWith::lidar) last_scan_ = now;
  if (!begins_plans(sensor) || !applies() || planning_ || now - last_ < kSteeringPeriod ||
      onboard_.flight.at_rest(now + kBudget))
    return;
  planning_ = true;
  last_ = now;
  const std::optional<double> exploring_s =
      goal_waits() ? std::nullopt : std::optional(seconds(now - parts_.phases.since()));
  const HorizonQuery asked = query(now + kBudget);
  asked_goal_ = asked.goal.position;
  asked_limits_ = asked.limits;
  onboard_.map.job(
      "horizon", kBudget,
      [asked, exploring_s](Explorer& explorer) { return explorer.plan_horizon(asked, exploring_s); },
      [this, now](const std::optional<HorizonPlan>& plan) { on_plan(plan, now); });
}

void Steering::note_goal() {
  const std::optional<Goal>& goal = parts_.goals.goal();
  if (goal && goal_ && (*goal_ - goal->position).norm() < kSame_m) return;
  goal_ = goal ? std::optional(goal->position) : std::nullopt;
  goal_since_ = onboard_.now();
  direct_s_.reset();
}

bool Steering::goal_waits() const {
  return direct_s_ && seconds(onboard_.now() - goal_since_) > kLater * *direct_s_ + kLater_s;
}

MotionLimits Steering::limits(const Goal& goal) const {
  return onboard_.flight.limits_of_plans(goal.max_speed_mps > 0 ? std::optional(goal.max_speed_mps)
                                                                : std::nullopt);
}

HorizonQuery Steering::query(TimeNs at) const {
  const Flight& flight = onboard_.flight;
  const Goal& goal = *parts_.goals.goal();
  HorizonQuery q;
  q.start = flight.motion_at(at);
  q.under_way = flight.samples_from(at);
  if (legs_ && at - legs_begin_ < kLegs * kLeg) q.last = moved_on(*legs_, at - legs_begin_);
  q.goal = {goal.position, goal.heading_rad};
  q.turns = turns();
  q.limits = limits(goal);
  q.braking_mps2 = kBrakingFraction * q.limits.max_acceleration_mps2;
  q.seed = static_cast<std::uint64_t>(at);
  return q;
}

void Steering::on_plan(const std::optional<HorizonPlan>& plan, TimeNs begun) {
  planning_ = false;
  const TimeNs now = onboard_.now();
  if (!plan || !applies() || parts_.path.outdated(begun)) return;
  // The goal, or the speed that is allowed, may have changed since.
  const Goal& goal = *parts_.goals.goal();
  if ((asked_goal_ - goal.position).norm() >= kSame_m || asked_limits_ != limits(goal)) return;
  const Reference& reference = onboard_.flight.reference();
  if ((reference.position - plan->start.position).norm() > kOff_m ||
      (reference.velocity_mps - plan->start.velocity_mps).norm() > kOff_mps)
    return;
  if (!direct_s_) direct_s_ = plan->time_left_s;
  legs_ = plan->legs;
  legs_begin_ = now;
  Course course;
  course.heading.along_path = turns();
  if (goal.max_speed_mps > 0) course.max_speed_mps = goal.max_speed_mps;
  Trajectory trajectory;
  trajectory.start = now;
  trajectory.samples = plan->samples;
  parts_.path.steer(course, trajectory);
}

}  // namespace karst::core
