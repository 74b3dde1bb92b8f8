#include "core_stack/mission/mission_control.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

namespace karst::core {
namespace {

constexpr TimeNs kControlPeriod = 10 * kMillisecond;
constexpr TimeNs kSupervisionPeriod = 100 * kMillisecond;

// A step that has not come for so long does not come any more.
constexpr TimeNs kControlMissed = 100 * kMillisecond, kSupervisionMissed = 500 * kMillisecond;

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
      control_watch_(kControlMissed),
      supervision_watch_(kSupervisionMissed),
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
  fly(watch);
  return end();
}

void MissionControl::fly(const Watch& watch) {
  begin(watch);
  advance(from_seconds(options_.mission.max_flight_time_s + kOverdue_s));
}

void MissionControl::begin(const Watch& watch) {
  watch_ = watch;
  control_watch_.came(now());
  supervision_watch_.came(now());
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
    if (!watch_(status)) land_now("stopped by the operator");
  });
}

/// Whatever fails, the steps go on: the vehicle has to come down.
bool MissionControl::advance(TimeNs until) {
  while (!result_) {
    try {
      executive_.run_until(until, [this] { return result_.has_value(); });
      break;
    } catch (const std::exception& e) {
      land_now(e.what());
    } catch (...) {
      land_now("an unknown exception");
    }
  }
  return !result_ && now() < from_seconds(options_.mission.max_flight_time_s + kOverdue_s);
}

/// What cannot be written does not keep the rest from being written.
MissionResult MissionControl::end() {
  std::string problem;
  const auto attempt = [&problem](const auto& step) {
    try {
      step();
    } catch (const std::exception& e) {
      if (problem.empty()) problem = e.what();
    } catch (...) {
      if (problem.empty()) problem = "an unknown exception";
    }
  };
  attempt([this] { executive_.drain(); });
  attempt([this] {
    finish("aborted", emergency_ ? *emergency_ + ": it did not come down"
                                 : "the vehicle did not come back within ten minutes after the time limit");
  });
  attempt([this] {
    if (team_) become_relay();
  });
  attempt([this] { vehicle_.finish(); });
  attempt([this] {
    if (description_.detects_objects) write_objects();
  });
  attempt([this] { recorder_.final_map(explorer_.map()); });
  if (!result_) result_ = MissionResult{"aborted", "", standing_, ""};
  result_->record_problem = problem;
  return *result_;
}

void MissionControl::land_now(const char* reason) noexcept {
  if (emergency_ || result_) return;
  emergency_.emplace();
  flight_.land_now(now());
  phase_ = Phase::land;
  try {  // telling of it may fail, too
    *emergency_ = reason;
    enter(Phase::land, reason);
    recorder_.event(now(), "safety", {{"action", "land"}, {"reason", reason}});
  } catch (...) {
  }
}

/// It is over, even if that cannot be told any more.
void MissionControl::finish(const std::string& outcome, const std::string& reason) {
  if (result_) return;
  result_ = MissionResult{"aborted", "", standing_ && outcome != "contact" && outcome != "battery", ""};
  result_->outcome = outcome;
  result_->reason = reason;
  enter(Phase::done, reason);
  settle_objects(outcome == "landed" || (team_ && result_->stands));
  recorder_.event(now(), "outcome",
                  {{"outcome", outcome}, {"reason", reason}, {"mass_kg", flight_.mass_kg()}});
  recorder_.flush();
}

void MissionControl::enter(Phase phase, const std::string& reason) {
  phase_ = phase;
  phase_since_ = now();
  last_landmark_ = flight_.reference().position;
  last_landmark_time_ = now();
  recorder_.event(now(), "phase", {{"phase", name_of(phase)}, {"reason", reason}});
}

void MissionControl::on_imu(const ImuSample& s) {
  if (s.stamp > now()) return;
  flight_.on_imu(s);
  watch_steps();
}

/// The vehicle's messages are a clock of their own: if the control step does not come, they take its place.
void MissionControl::watch_steps() {
  if (supervision_watch_.missing(now())) land_now("supervision does not come any more");
  if (control_watch_.missing(now())) land_now("control does not come any more");
  if (emergency_ && !result_ && control_watch_.since(now()) > kControlPeriod) control();
}

void MissionControl::control() {
  control_watch_.came(now());
  if (emergency_ && standing_) return touch_down(now());
  vehicle_.command(flight_.control(now()));
}

void MissionControl::supervise() {
  supervision_watch_.came(now());
  record();
  if (emergency_) return;
  keep_safe();
  if (team_) keep_apart();
  switch (phase_) {
    case Phase::standby:
      if (now() - phase_since_ < kSettling || (team_ && !airspace_clear())) break;
      flight_.climb(now(), options_.mission.takeoff_height_m, kClimbSpeed_mps);
      enter(Phase::takeoff, "");
      break;
    case Phase::takeoff:
      if (flight_.at_rest(now() - kSettling)) end_take_off();
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

void MissionControl::end_take_off() {
  if (standing_) {
    flight_.disarm();
    return finish("stuck", "it does not lift off: too heavy for its motors?");
  }
  if (braked_at_ && !hover_chosen_) return choose_hover();
  if (executive_.under_way("hover") > 0) return;
  has_taken_off_ = true;
  home_ = flight_.reference().position;
  flown_ = {home_};
  executive_.job(
      "home", Lane::map, kMappingBudget, [this, home = home_] { explorer_.set_home(home); }, [] {});
  // A vehicle that sees all around already has nothing to look around for.
  if (!description_.lidar) flight_.look_around(now(), turn_to_see_all_around(description_));
  enter(description_.lidar ? Phase::explore : Phase::look, "");
}

/// A roof stopped the take-off. To this place it comes back at the end: it had better have room there.
void MissionControl::choose_hover() {
  hover_chosen_ = true;
  auto hover = std::make_shared<Vec3>();
  executive_.job(
      "hover", Lane::map, kMappingBudget,
      [this, hover, highest = flight_.reference().position] { *hover = explorer_.hover_below(highest); },
      [this, hover] {
        if (phase_ != Phase::takeoff) return;
        const double up_m = hover->z() - description_.T_world_start.position.z();
        recorder_.event(
            now(), "log",
            {{"text", "a low roof: it hovers " + std::to_string(up_m).substr(0, 4) + " m up, not " +
                          std::to_string(options_.mission.takeoff_height_m).substr(0, 4) + " m"}});
        flight_.climb(now(), hover->z() - flight_.reference().position.z(), kClimbSpeed_mps);
      });
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
  if (team_ && !emergency_ && now() % kSecond == 0) {
    if (has_taken_off_) share();
    note_objects_at_base(team_->known_at_base());
  }
  if (now() % kSecond == 0 && !recorder_.flush() && phase_ == Phase::explore)
    begin_homing("the run directory cannot be written any more (disk full?)");
}

void MissionControl::on_ground(TimeNs stamp, bool standing) {
  standing_ = standing;
  const bool takes_off = !has_taken_off_ && phase_ != Phase::land;  // it may touch once more
  if (standing && !takes_off && phase_ != Phase::done) touch_down(stamp);
}

/// Motors off, before anything else: who has lost the pose would never come down again.
void MissionControl::touch_down(TimeNs stamp) {
  flight_.disarm();
  vehicle_.command(flight_.control(stamp));
  try {
    finish_on_ground();
  } catch (...) {  // it stands, even if that cannot be told
    if (!result_) result_ = MissionResult{"aborted", "", true, ""};
    throw;
  }
}

void MissionControl::finish_on_ground() {
  const Vec3& there = landing_ ? landing_->ground : description_.T_world_start.position;
  const double off_m = (flight_.state().position - there).head<2>().norm();
  const std::string place = std::to_string(off_m).substr(0, 5) + " m from the start";
  if (emergency_)
    finish("aborted", *emergency_ + ": on the ground " + place);
  else if (phase_ != Phase::land)
    finish("contact", std::string("touched the ground in phase ") + name_of(phase_));
  else if (off_m < 1.0)
    finish("landed", landing_ ? "as a relay" : "at the start");
  else
    finish("stuck", "on the ground " + place);
}

void MissionControl::on_lost(TimeNs, const std::string& outcome, const std::string& reason) {
  finish(outcome, reason);
}

}  // namespace karst::core
