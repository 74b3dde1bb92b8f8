// What mission control does when the map closes the path ahead, and when the supervisor says so.
#include <nlohmann/json.hpp>

#include "core_stack/mission/mission_control.h"

namespace karst::core {
namespace {

/// A closed place is flown around if a new path can be found before the vehicle would have to brake for it;
/// otherwise it brakes at once. Metres kept in hand beyond the braking distance.
constexpr double kDetourMargin_m = 0.5;

}  // namespace

/// What is left of the trajectory and has to be clear.
std::vector<Vec3> MissionControl::path_ahead() const {
  std::vector<Vec3> ahead = flight_.until_end(std::max(now(), tight_until_)).points;
  if (phase_ == Phase::takeoff) {  // it leaves the ground, which is near: a low roof is what matters
    const double above_ground_m =
        description_.T_world_start.position.z() + options_.planning.clearance_m + options_.map.resolution_m;
    std::erase_if(ahead, [&](const Vec3& p) { return p.z() < above_ground_m; });
  }
  return ahead;
}

void MissionControl::brake() {
  flight_.brake(now());
  braked_at_ = now();
}

/// Whether what was planned from `t` on may not be followed any more.
bool MissionControl::braked_since(TimeNs t) const {
  return (braked_at_ && *braked_at_ >= t) || verdict_.action == SafetyAction::brake;
}

void MissionControl::on_map_update(const std::vector<CellChange>& changes,
                                   std::optional<double> blocked_after_m, bool goal_alive) {
  recorder_.map_changes(now(), changes);
  goal_alive_ = goal_alive;
  if (!blocked_after_m || path_blocked_ || flight_.at_rest(now())) return;
  if (phase_ == Phase::takeoff && hover_chosen_) return;  // down again from below a roof
  const std::string reason = "the map now forbids the path ahead";
  drop_next_goal(PolicyEvent::Kind::goal_unreachable, reason);
  // What a decision and its plan take in flight, and then the stretch to stop in.
  const TimeNs decided = now() + kMappingBudget + from_seconds(options_.mission.decision_budget_s);
  const Flight::Onward until_decided = flight_.until_end(now()), stop = flight_.until_stop(decided);
  const double needed_m =
      seconds(decided - now()) * until_decided.speed_mps + path_length_m(stop.points) + kDetourMargin_m;
  if (*blocked_after_m > needed_m && phase_ != Phase::takeoff) {
    if (flying_as_come_) return;  // nothing else leads home; from near, what is there may look otherwise
    if (!detour_due_)
      recorder_.event(now(), "safety",
                      {{"action", "replan"}, {"reason", reason}, {"after_m", *blocked_after_m}});
    detour_due_ = true;
    return;
  }
  path_blocked_ = phase_ != Phase::takeoff;  // from there, exploring goes on below the roof
  detour_due_ = false;
  recorder_.event(now(), "safety", {{"action", "brake"}, {"reason", reason}, {"after_m", *blocked_after_m}});
  brake();
}

void MissionControl::keep_safe() {
  if (phase_ == Phase::standby || phase_ == Phase::land || phase_ == Phase::done) {
    last_seen_ = now();
    return;
  }
  SafetyObservation o;
  o.now = now();
  o.estimate = flight_.estimator().diagnose(now());
  o.tracking_error_m = (flight_.state().position - flight_.reference().position).norm();
  const bool under_way = phase_ == Phase::explore || phase_ == Phase::home;
  if (under_way) o.hull_clearance_m = hull_clearance_m_;  // not while it lifts off from the ground
  o.blind_s = seconds(now() - last_seen_);
  o.battery_s = battery_.seconds_left;
  const SafetyVerdict verdict = safety_.judge(o);
  if (verdict == verdict_) return;
  verdict_ = verdict;
  recorder_.event(now(), "safety", {{"action", name_of(verdict.action)}, {"reason", verdict.reason}});
  const bool slow = verdict.action != SafetyAction::none;
  if (under_way)
    flight_.cap_speed(now(), options_.motion.max_speed_mps * (slow ? options_.safety.slow_share : 1.0));
  if (verdict.action == SafetyAction::land) {
    brake();
    enter(Phase::land, verdict.reason);
  } else if (verdict.action == SafetyAction::home && phase_ == Phase::explore) {
    begin_homing(verdict.reason);
  } else if (verdict.action == SafetyAction::brake && under_way && !flight_.at_rest(now())) {
    drop_next_goal(PolicyEvent::Kind::goal_superseded, verdict.reason);
    brake();
    path_blocked_ = true;  // and look for a new way from there
  }
}

}  // namespace karst::core
