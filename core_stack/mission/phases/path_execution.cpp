#include "core_stack/mission/phases/path_execution.h"

#include <algorithm>

namespace karst::core {
namespace {

/// The vehicle flies around a blocked place if a new path can be found before it must brake; otherwise it
/// brakes at once. This is the margin beyond the braking distance, in metres.
constexpr double kDetourMargin_m = 0.5;

/// Why a route is flown as a sampled trajectory instead of its polynomial.
std::string why_sampled(const std::optional<PolynomialTrajectory>& polynomial) {
  if (!polynomial) return "a way back as come, or through a tight place";
  return polynomial->fell_back.empty() ? "the motion has changed since it was made" : polynomial->fell_back;
}

}  // namespace

RouteStart PathExecution::start(Flight::CommittedSegment committed, TimeNs at) const {
  return {.at = at,
          .committed = std::move(committed),
          .limits = flight_.limits(),
          .narrow_places = narrow_places_};
}

RouteStart PathExecution::start_at_stop(TimeNs at) const { return start(flight_.until_stop(at), at); }
RouteStart PathExecution::start_at_end(TimeNs at) const { return start(flight_.until_end(at), at); }

void PathExecution::follow(const Route& route, TimeNs now) {
  // It was made for the state expected now and the speed limit at that time: either may have changed.
  const auto& polynomial = route.polynomial;
  const bool fits = polynomial && polynomial->fell_back.empty() && polynomial->trajectory.start == now &&
                    (flight_.expected(now).position - route.points.front()).norm() < 0.01 &&
                    flight_.limits().max_speed_mps >= polynomial->speed_limit_mps;
  event::Plan plan{.points = route.points,
                   .from = route.points.front(),
                   .to = route.points.back(),
                   .length_m = path_length_m(route.points),
                   .length_bound = route.path.length_bound,
                   .narrow = route.path.narrow()};
  if (options_.motion.trajectory == TrajectoryKind::polynomial) {
    plan.trajectory = fits ? TrajectoryKind::polynomial : TrajectoryKind::sampled;
    plan.rounds = polynomial ? polynomial->rounds : 0;
    plan.fell_back = fits ? "" : why_sampled(polynomial);
  }
  recorder_.write(now, plan);
  const double start_speed_mps = flight_.at_rest(now) ? 0.0 : route.start_speed_mps;
  const bool still_so = !route.sampled.samples.empty() && start_speed_mps == route.start_speed_mps &&
                        flight_.limits(route.max_speed_mps) == route.limits;
  const Course course{.points = route.points,
                      .start_speed_mps = start_speed_mps,
                      .start = now,
                      .heading = route.heading,
                      .max_speed_mps = route.max_speed_mps,
                      .slow = route.slow};
  if (fits) {
    flight_.follow(course, polynomial->trajectory);
  } else if (still_so) {
    Trajectory sampled = route.sampled;
    sampled.start = now;
    flight_.follow(course, sampled);
  } else {
    flight_.follow(course);
  }
  narrow_places_ = route.slow.places;
  as_come_ = false;
  speed_limited_ = route.max_speed_mps < options_.motion.max_speed_mps;
  const Path& path = route.path;
  tight_until_ =
      path.escape_points == 0
          ? 0
          : flight_.time_nearest(path.points[std::min(path.escape_points, path.points.size() - 1)]);
  blocked_ = false;
  detour_due_ = false;
}

void PathExecution::steer(const Course& course, const Trajectory& plan) {
  flight_.follow(course, plan);
  narrow_places_.clear();
  as_come_ = speed_limited_ = false;
  tight_until_ = 0;
}

void PathExecution::brake(TimeNs now) {
  flight_.brake(now);
  braked_at_ = now;
}

void PathExecution::stop(TimeNs now) {
  if (!flight_.at_rest(now)) brake(now);
}

std::vector<Vec3> PathExecution::ahead(TimeNs now, std::optional<double> ground_m) const {
  std::vector<Vec3> ahead = flight_.until_end(std::max(now, tight_until_)).points;
  if (ground_m) std::erase_if(ahead, [&](const Vec3& p) { return p.z() < *ground_m; });
  return ahead;
}

void PathExecution::avoid(double after_m, const PhaseMachine& phases, TimeNs now) {
  const std::string reason = kPathForbidden;
  // The distance flown during a decision and its plan, plus the stopping distance.
  const TimeNs decided = now + kMappingBudget + from_seconds(options_.mission.decision_budget_s);
  const Flight::CommittedSegment until_decided = flight_.until_end(now), stop = flight_.until_stop(decided);
  const double needed_m =
      seconds(decided - now) * until_decided.speed_mps + path_length_m(stop.points) + kDetourMargin_m;
  const bool takes_off = phases.in(Phase::takeoff);
  if (after_m > needed_m && !takes_off) {
    if (as_come_) return;  // other paths lead far round, or not home; the map may change nearer to the place
    if (!detour_due_) recorder_.write(now, event::Safety{SafetyAction::replan, reason, after_m});
    detour_due_ = true;
    return;
  }
  blocked_ = !takes_off;  // below a roof, exploration starts from there
  detour_due_ = false;
  recorder_.write(now, event::Safety{SafetyAction::brake, reason, after_m});
  brake(now);
}

}  // namespace karst::core
