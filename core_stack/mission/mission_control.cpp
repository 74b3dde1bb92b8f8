#include "core_stack/mission/mission_control.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

namespace karst::core {
namespace {

constexpr TimeNs kControlPeriod = 10 * kMillisecond;
constexpr TimeNs kSupervisionPeriod = 100 * kMillisecond;

constexpr TimeNs kSettling = kSecond;  // on the ground, for the estimate
constexpr double kClimbSpeed_mps = 0.5;
constexpr double kFlownStep_m = 0.25;
constexpr double kOverdue_s = 600;                // beyond the time limit: then it is given up
constexpr TimeNs kLastLook = 300 * kMillisecond;  // for the last images of the look around to come in

/// What the widest camera sees without turning need not be turned to; a little is seen twice.
double turn_to_see_all_around(const VehicleDescription& vehicle) {
  constexpr double kOverlap_rad = 0.2;
  double seen_rad = 0;
  for (const auto& camera : vehicle.cameras) seen_rad = std::max(seen_rad, camera->horizontal_fov_rad);
  return std::max(0.0, 2 * std::numbers::pi - std::max(0.0, seen_rad - kOverlap_rad));
}

}  // namespace

const char* name_of(Phase phase) {
  switch (phase) {
    case Phase::standby:
      return "standby";
    case Phase::takeoff:
      return "takeoff";
    case Phase::look:
      return "look";
    case Phase::explore:
      return "explore";
    case Phase::home:
      return "home";
    case Phase::land:
      return "land";
    case Phase::done:
      return "done";
  }
  return "?";
}

MissionControl::MissionControl(const CoreOptions& options, Vehicle& vehicle, Executive& executive,
                               PolicyPort& policy, Recorder& recorder, Teamwork* team)
    : options_(options),
      description_(vehicle.description()),
      vehicle_(vehicle),
      executive_(executive),
      recorder_(recorder),
      team_(team),
      flight_(options, description_),
      safety_(options.safety),
      explorer_(options, description_, policy),
      objects_(options.objects) {
  if (description_.lidar && options.localization.source == "lidar")
    loam_.emplace(options.localization.loam, description_.T_world_start);
  battery_.seconds_left = options.mission.max_flight_time_s;
  if (!team_) return;
  explorer_.join(team_->homing(), team_->options().claim_radius_m);
  nodes_left_ = team_->options().nodes;
}

MissionResult MissionControl::run(const Watch& watch) {
  begin(watch);
  advance(from_seconds(options_.mission.max_flight_time_s + kOverdue_s));
  return end();
}

void MissionControl::begin(const Watch& watch) {
  watch_ = watch;
  enter(Phase::standby, "");
  executive_.job(
      "launch site", Lane::map, kMappingBudget, [this] { explorer_.declare_launch_site(explorer_.home()); },
      [] {});
  vehicle_.start(executive_, *this);
  executive_.every("control", kControlPeriod, kControlPeriod, [this] { control(); });
  executive_.every("supervise", kSupervisionPeriod, kSupervisionPeriod, [this] { supervise(); });
  executive_.every("watch", kSecond, kSecond, [this] {
    const MissionStatus status{now(),
                               phase_,
                               battery_.fraction_left,
                               battery_.seconds_left,
                               explored_m3_,
                               flight_.state().velocity_mps.norm(),
                               goal_ ? goal_->why : ""};
    if (const int overruns = executive_.overruns(); overruns > overruns_) {
      recorder_.event(now(), "overrun", {{"count", overruns - overruns_}});
      overruns_ = overruns;
    }
    if (!watch_(status)) finish("aborted", "stopped by the operator");
  });
}

bool MissionControl::advance(TimeNs until) {
  try {
    if (!result_) executive_.run_until(until, [this] { return result_.has_value(); });
  } catch (const std::exception& e) {
    executive_.drain();  // jobs still running use what unwinding would take away
    finish("aborted", std::string("an error of the core: ") + e.what());
  }
  return !result_ && now() < from_seconds(options_.mission.max_flight_time_s + kOverdue_s);
}

MissionResult MissionControl::end() {
  executive_.drain();
  if (!result_) finish("aborted", "the vehicle did not come back within ten minutes after the time limit");
  if (team_) become_relay();
  vehicle_.finish();
  if (description_.detects_objects) write_objects();
  recorder_.final_map(explorer_.map());
  return *result_;
}

void MissionControl::finish(const std::string& outcome, const std::string& reason) {
  if (result_) return;
  enter(Phase::done, reason);
  settle_objects(outcome == "landed" || (team_ && outcome == "stuck"));
  recorder_.event(now(), "outcome",
                  {{"outcome", outcome}, {"reason", reason}, {"mass_kg", flight_.mass_kg()}});
  recorder_.flush();
  result_ = MissionResult{outcome, reason};
}

void MissionControl::enter(Phase phase, const std::string& reason) {
  phase_ = phase;
  phase_since_ = now();
  last_landmark_ = flight_.reference().position;
  last_landmark_time_ = now();
  recorder_.event(now(), "phase", {{"phase", name_of(phase)}, {"reason", reason}});
}

void MissionControl::control() { vehicle_.command(flight_.control(now())); }

void MissionControl::supervise() {
  record();
  keep_safe();
  if (team_) keep_apart();
  switch (phase_) {
    case Phase::standby:
      if (now() - phase_since_ < kSettling || (team_ && !airspace_clear())) break;
      flight_.climb(now(), options_.mission.takeoff_height_m, kClimbSpeed_mps);
      enter(Phase::takeoff, "");
      break;
    case Phase::takeoff:
      if (!flight_.at_rest(now() - kSettling)) break;
      if (standing_) {
        flight_.disarm();
        finish("stuck", "it does not lift off: too heavy for its motors?");
        break;
      }
      has_taken_off_ = true;
      home_ = flight_.reference().position;
      flown_ = {home_};
      executive_.job(
          "home", Lane::map, kMappingBudget, [this, home = home_] { explorer_.set_home(home); }, [] {});
      // A vehicle that sees all around already has nothing to look around for.
      if (!description_.lidar) flight_.look_around(now(), turn_to_see_all_around(description_));
      enter(description_.lidar ? Phase::explore : Phase::look, "");
      break;
    case Phase::look:
      if (flight_.at_rest(now() - kLastLook)) enter(Phase::explore, "");
      break;
    case Phase::explore:
      explore();
      watch_battery();
      break;
    case Phase::home:
      go_home();
      break;
    case Phase::land:
      land();
      break;
    case Phase::done:
      break;
  }
}

void MissionControl::record() {
  recorder_.pose(flight_.state());
  recorder_.telemetry({now(), name_of(phase_), flight_.state(), flight_.reference().position,
                       battery_.fraction_left, battery_.seconds_left, explored_m3_, home_distance_m_});
  if (has_taken_off_) {
    const Vec3& here = flight_.reference().position;
    if (const double step_m = (flown_.back() - here).norm(); step_m > kFlownStep_m) {
      flown_m_ += step_m;
      flown_.push_back(here);
    }
  }
  if (team_) report_state();
  if (team_ && has_taken_off_ && now() % kSecond == 0) share();
  if (team_ && now() % kSecond == 0) note_objects_at_base(team_->known_at_base());
  if (now() % kSecond == 0 && !recorder_.flush() && phase_ == Phase::explore)
    begin_homing("the run directory cannot be written any more (disk full?)");
}

void MissionControl::on_ground(TimeNs stamp, bool standing) {
  standing_ = standing;
  if (!standing || !has_taken_off_ || phase_ == Phase::done) return;
  flight_.disarm();
  vehicle_.command(flight_.control(stamp));
  if (phase_ != Phase::land) {
    finish("contact", std::string("touched the ground in phase ") + name_of(phase_));
    return;
  }
  const Vec3& there = landing_ ? landing_->ground : description_.T_world_start.position;
  const double off_m = (flight_.state().position - there).head<2>().norm();
  if (off_m < 1.0) {
    finish("landed", landing_ ? "as a relay" : "at the start");
  } else {
    finish("stuck", "on the ground " + std::to_string(off_m).substr(0, 5) + " m from the start");
  }
}

void MissionControl::on_lost(TimeNs, const std::string& outcome, const std::string& reason) {
  finish(outcome, reason);
}

}  // namespace karst::core
