#include "core_stack/mission/mission_control.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/mission/flight/trusted_speeds.h"

namespace karst::core {
namespace {

constexpr TimeNs kControlPeriod = 10 * kMillisecond;
constexpr TimeNs kSupervisionPeriod = 100 * kMillisecond;

// A step that has been missing for this long has failed.
constexpr TimeNs kControlMissed = 100 * kMillisecond, kSupervisionMissed = 500 * kMillisecond;

constexpr TimeNs kSettling = kSecond;             // on the ground, until the estimate has converged
constexpr double kOverdue_s = 600;                // beyond the time limit: then the flight is aborted
constexpr TimeNs kLastLook = 300 * kMillisecond;  // for the last images of the turn to arrive

/// How far back along the flown path a vehicle that must land may search for ground: at 0.6 m/s on average
/// (EmergencyLanding), with time left to descend.
double path_back_m(double battery_seconds_left) {
  constexpr double kFarthest_m = 55, kMean_mps = 0.6, kDescent_s = 15;
  return std::clamp(kMean_mps * (battery_seconds_left - kDescent_s), 0.0, kFarthest_m);
}

/// The longest sideways flight on a pose that may no longer be valid.
constexpr double kDoubtfulPath_m = 4.5;
constexpr double kAnyPath_m = std::numeric_limits<double>::infinity();

}  // namespace

MissionControl::MissionControl(const CoreOptions& options, Vehicle& vehicle, Executive& executive,
                               PolicyPort& policy, Recorder& recorder, Teamwork* team)
    : onboard_(options, vehicle.description(), executive, recorder, policy),
      vehicle_(vehicle),
      endurance_(options.mission.max_flight_time_s),
      goals_(recorder),
      path_(onboard_),
      take_off_(onboard_, phases_, path_),
      team_(in_team(team)),
      sensors_(onboard_, sensor_wiring()),
      earlier_map_(onboard_),
      exploration_(onboard_, {phases_, goals_, path_, flown_path_, endurance_}, exploration_wiring()),
      steering_(onboard_, {phases_, goals_, path_}),
      return_home_(onboard_,
                   {phases_, goals_, path_, flown_path_, endurance_,
                    team_ && team_->landing ? &*team_->landing : nullptr},
                   home_wiring()),
      objects_(onboard_, team),
      safety_(options.safety),
      control_watch_(kControlMissed),
      supervision_watch_(kSupervisionMissed),
      authority_(onboard_.vehicle.authority) {
  if (team) onboard_.map.while_idle().join(team->homing(), team->options().claim_radius_m);
}

std::optional<MissionControl::InTeam> MissionControl::in_team(Teamwork* team) {
  if (!team) return std::nullopt;
  InTeam out{*team, TeamSharing(onboard_, *team, {phases_, path_, endurance_}),
             RightOfWay(onboard_, *team, {phases_, goals_, path_, flown_path_}), std::nullopt};
  if (team->lands_as_relay()) out.landing.emplace(onboard_, *team, phases_, endurance_);
  return out;
}

SensorPipeline::Wiring MissionControl::sensor_wiring() {
  return {.ask = [this] { return map_question(); },
          .tell = [this](const MapNews& news) { on_map(news); },
          .others =
              [this](TimeNs stamp) {
                return team_ ? team_->sharing.others_at(stamp) : std::vector<MovingBody>{};
              },
          .look_for_others = [this] { return team_ && team_->work.may_meet_unheard(now()); }};
}

Exploration::Wiring MissionControl::exploration_wiring() {
  return {.go_home = [this](const std::string& reason) { return_home_.begin(reason); },
          .claim =
              [this](const Goal& goal) {
                if (team_) team_->sharing.claim_goal(goal);
              },
          .teammates = [this] { return team_ ? team_->sharing.teammates() : std::vector<TeammateState>{}; }};
}

ReturnHome::Wiring MissionControl::home_wiring() {
  return {.enter = [this](Phase phase, const std::string& reason) { enter(phase, reason); },
          .land_here = [this](const std::string& reason) { land_here(reason); },
          .in_company = [this] { return team_ && team_->sharing.in_company(); },
          .give_up_goals =
              [this] {
                if (team_) team_->sharing.give_up_goals();
              }};
}

MissionResult MissionControl::run(const Watch& watch) {
  fly(watch);
  return end();
}

void MissionControl::fly(const Watch& watch) {
  begin(watch);
  while (advance(latest_end())) {  // later by the time it waits for a pilot
  }
}

void MissionControl::begin(const Watch& watch) {
  watch_ = watch;
  control_watch_.came(now());
  supervision_watch_.came(now());
  enter(Phase::standby, "");
  onboard_.map.job("launch site", kMappingBudget,
                   [](Explorer& explorer) { explorer.declare_launch_site(explorer.home()); });
  vehicle_.start(onboard_.executive, *this);
  onboard_.executive.every("control", kControlPeriod, kControlPeriod, [this] { control(); });
  onboard_.executive.every("supervise", kSupervisionPeriod, kSupervisionPeriod, [this] { supervise(); });
  onboard_.executive.every("watch", kSecond, kSecond, [this] { report_to_watcher(); });
}

TimeNs MissionControl::latest_end() const {
  return endurance_.begun() + from_seconds(onboard_.options.mission.max_flight_time_s + kOverdue_s);
}

/// Whatever fails, the steps continue: the vehicle must land.
bool MissionControl::advance(TimeNs until) {
  while (!result_) {
    try {
      onboard_.executive.run_until(until, [this] { return result_.has_value(); });
      break;
    } catch (const std::exception& e) {
      land_now(e.what());
    } catch (...) {
      land_now("an unknown exception");
    }
  }
  return !result_ && now() < latest_end();
}

/// A file that cannot be written does not prevent the others from being written.
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
  attempt([this] { onboard_.executive.drain(); });
  attempt([this] {
    finish(MissionOutcome::aborted,
           emergency_ ? *emergency_ + ": it did not come down"
                      : "the vehicle did not come back within ten minutes after the time limit");
  });
  if (!result_) result_ = MissionResult{MissionOutcome::aborted, "", standing_, ""};
  attempt([this] {
    if (!team_) return;
    const bool where_it_should = result_->outcome == MissionOutcome::landed;
    team_->sharing.become_relay(result_->stands,
                                where_it_should ? std::optional(return_home_.hover()) : std::nullopt);
  });
  attempt([this] { vehicle_.finish(); });
  attempt([this] {
    if (onboard_.vehicle.detects_objects) objects_.write();
  });
  const auto check_record = [this](bool good) {
    if (!good)
      throw InputError(onboard_.recorder.directory().string(), "", "cannot be written: is the disk full?");
  };
  attempt([&] { check_record(onboard_.recorder.flush()); });
  attempt([this] { onboard_.recorder.final_map(onboard_.map.while_idle().map()); });
  attempt([&] { check_record(onboard_.recorder.close()); });
  result_->record_problem = problem;
  return *result_;
}

void MissionControl::land_now(const char* reason) noexcept { end_flight(reason, kDoubtfulPath_m); }

void MissionControl::end_flight(const char* reason, double max_path_m) noexcept {
  if (emergency_ || result_) return;
  emergency_.emplace();
  onboard_.flight.land_now(now(), max_path_m);
  sensors_.close();
  phases_.enter(Phase::land, now());
  try {  // recording the failure may fail, too
    *emergency_ = reason;
    enter(Phase::land, reason);
    onboard_.recorder.write(now(), event::Safety{SafetyAction::land, reason});
  } catch (...) {
  }
}

/// The mission is over, even if this can no longer be recorded.
void MissionControl::finish(MissionOutcome outcome, const std::string& reason) {
  if (result_) return;
  result_ = MissionResult{
      outcome, "", standing_ && outcome != MissionOutcome::contact && outcome != MissionOutcome::battery, ""};
  result_->reason = reason;
  enter(Phase::done, reason);
  objects_.finish(outcome == MissionOutcome::landed || (team_ && result_->stands));
  onboard_.recorder.write(now(), event::Outcome{outcome, reason, onboard_.flight.mass_kg()});
  onboard_.recorder.flush();
}

void MissionControl::enter(Phase phase, const std::string& reason) {
  phases_.enter(phase, now());
  if (phase == Phase::explore) exploration_.begin();
  onboard_.recorder.write(now(), event::Phase{phase, reason});
}

void MissionControl::on_imu(const ImuSample& s) {
  if (s.stamp > now()) return;
  onboard_.flight.on_imu(s, now());
  watch_steps();
}

/// The vehicle's messages serve as a second clock: if the control step is missing, they replace it.
void MissionControl::watch_steps() {
  if (supervision_watch_.missing(now())) land_now("supervision does not come any more");
  if (control_watch_.missing(now())) land_now("control does not come any more");
  if (emergency_ && !result_ && control_watch_.since(now()) > kControlPeriod) control();
}

void MissionControl::report_to_watcher() {
  const MissionStatus status{now(),
                             phase(),
                             endurance_.battery(),
                             sensors_.explored_m3(),
                             onboard_.flight.state().velocity_mps.norm(),
                             goals_.goal() ? goals_.goal()->why : "",
                             waits_for()};
  if (const int overruns = onboard_.executive.overruns(); overruns > overruns_) {
    onboard_.recorder.write(now(), event::Overrun{overruns - overruns_});
    overruns_ = overruns;
  }
  if (const TimeNs lost = onboard_.executive.lost_time(); lost > lost_time_) {
    onboard_.recorder.write(now(), event::Log{"the loop was far behind: its clock was set back by " +
                                              std::to_string((lost - lost_time_) / kMillisecond) + " ms"});
    lost_time_ = lost;
  }
  if (!watch_(status)) end_flight("stopped by the operator", kAnyPath_m);
}

void MissionControl::control() {
  control_watch_.came(now());
  if (emergency_ && standing_) return touch_down(now());
  vehicle_.command(onboard_.flight.control(now()));
}

void MissionControl::supervise() {
  supervision_watch_.came(now());
  record();
  shed_load();
  if (authority_ != Authority::core) onboard_.flight.hover_here(now());  // no jump when it is the core again
  if (emergency_) return;
  keep_safe();
  if (team_) team_->right_of_way.step();
  fly_phase();
}

/// In lockstep no lane is ever late.
void MissionControl::shed_load() {
  const auto note = [this](const std::optional<LaneLoad::Change>& change, Lane lane) {
    if (!change) return;
    const std::string behind = std::to_string(change->behind / kMillisecond) + " ms behind";
    onboard_.recorder.write(
        now(), event::Degraded{
                   change->relief, change->begins ? event::DegradedState::begins : event::DegradedState::over,
                   std::string(name_of(lane)) + (change->begins ? " is " + behind : " keeps up again"),
                   seconds(change->since)});
  };
  Executive& executive = onboard_.executive;
  note(onboard_.load.observe_map(now(), executive.take_lateness(Lane::map)), Lane::map);
  note(onboard_.load.observe_localization(now(), executive.take_lateness(Lane::localization)),
       Lane::localization);
}

void MissionControl::fly_phase() {
  switch (phase()) {
    case Phase::standby:
      if (authority_ != Authority::core) {
        return_home_.watch_time();  // the roadmaps follow the map
        return endurance_.begin(now());
      }
      if (now() - phases_.since() < kSettling || (team_ && !team_->sharing.airspace_clear())) break;
      if (!checks_hold()) return endurance_.begin(now());
      take_off_.begin();
      enter(Phase::takeoff, "");
      break;
    case Phase::takeoff:
      take_off();
      break;
    case Phase::look:
      look();
      break;
    case Phase::explore:
      earlier_map_.step();
      exploration_.step();
      return_home_.watch_time();
      break;
    case Phase::home:
      earlier_map_.end();
      return_home_.step();
      break;
    case Phase::land:
      earlier_map_.end();
      land();
      break;
    case Phase::manual:
      return_home_.watch_time();  // and the roadmaps follow the map
      break;
    case Phase::done:
    case Phase::replay:
      break;
  }
}

/// Whether the vehicle's own checks hold. What does not is recorded once.
bool MissionControl::checks_hold() {
  std::string why_not;
  for (const VehicleCheck& check : vehicle_.checks())
    if (!check.holds)
      why_not += (why_not.empty() ? "" : "; ") + check.name + " must be " + check.required +
                 (check.found.empty() ? ", and is not known" : ", and is " + check.found);
  if (why_not != why_not_ && !why_not.empty())
    onboard_.recorder.write(now(), event::Log{"it waits on the ground: " + why_not});
  why_not_ = why_not;
  return why_not.empty();
}

/// Of the reasons that are recorded as events, the present one.
std::string MissionControl::waits_for() const {
  const bool pilot = authority_ != Authority::core;
  if (phases_.in(Phase::manual) && pilot)
    return std::string("the ") + name_of(authority_) + " steers: " + authority_reason_;
  const std::string& reason = pilot ? authority_reason_ : why_not_;
  return phases_.in(Phase::standby) && !reason.empty() ? "waits: " + reason : "";
}

void MissionControl::take_off() {
  switch (take_off_.step(standing_)) {
    case TakeOff::State::climbs:
      return;
    case TakeOff::State::does_not_lift:
      switch_off_motors(now());
      return finish(MissionOutcome::stuck, "it does not lift off: too heavy for its motors?");
    case TakeOff::State::hovers:
      break;
  }
  const Vec3& hover = onboard_.flight.reference().position;
  flown_path_.begin(hover);
  return_home_.set_home(hover);
  // A vehicle that sees all around need not turn to look around.
  if (onboard_.vehicle.lidar && earlier_map_.undecided())
    return enter(Phase::look, "it looks for its place in the earlier map");
  if (onboard_.vehicle.lidar) return enter(Phase::explore, "");
  onboard_.flight.look_around(now(), turn_to_see_all_around(onboard_.vehicle));
  enter(Phase::look, "");
}

void MissionControl::look() {
  earlier_map_.step();
  if (endurance_.seconds_left(now()) < onboard_.options.mission.home_reserve_s) earlier_map_.hurry();
  if (earlier_map_.undecided() || !onboard_.flight.at_rest(now() - kLastLook)) return;
  const std::string& refusal = earlier_map_.refusal();
  if (refusal.empty()) return enter(Phase::explore, "");
  onboard_.recorder.write(now(), event::Safety{SafetyAction::land, refusal});
  enter(Phase::land, refusal);
}

/// Lands as in an emergency: where the ground is known to be suitable.
void MissionControl::land_here(const std::string& reason) {
  lands_lost_ = onboard_.flight.estimator().health(now()) == Health::lost;
  onboard_.flight.land_now(now(), lands_lost_ ? kDoubtfulPath_m : kAnyPath_m);
  enter(Phase::land, reason);
}

/// Whether it lands because the pose was lost, and now has a pose again in the map for the flight home.
bool MissionControl::found_again() const {
  return lands_lost_ && flown_path_.begun() && sensors_.located_in_first_map() &&
         onboard_.flight.estimator().health(now()) == Health::good;
}

void MissionControl::land() {
  if (standing_) return touch_down(now());  // it had not left the ground
  if (found_again()) {
    forget_causes();
    onboard_.flight.hover_here(now());
    return return_home_.begin("the pose is known again");
  }
  if (!onboard_.flight.at_rest(now())) return;
  // Descend until ground contact; the height above ground is known no better than the map.
  const MissionOptions& o = onboard_.options.mission;
  onboard_.flight.climb(now(), -(o.takeoff_height_m + 0.5), o.landing_speed_mps);
}

/// Whatever slowed or stopped it is over: an action that outlives its cause would stop it again.
void MissionControl::forget_causes() {
  lands_lost_ = false;
  safety_ = SafetySupervisor(onboard_.options.safety);
  verdict_ = {};
  path_.obey(SafetyAction::none);
}

/// Each reason is recorded: it tells the operator what the vehicle waits for.
void MissionControl::on_authority(TimeNs, Authority who, const std::string& reason) {
  if (result_ || (who == authority_ && reason == authority_reason_)) return;
  const bool same = who == std::exchange(authority_, who);
  authority_reason_ = reason;
  onboard_.recorder.write(now(), event::Authority{who, reason});
  if (same || phases_.in(Phase::standby)) return;
  if (who == Authority::core)
    take_over();
  else
    let_go(reason);
}

void MissionControl::on_gap() { onboard_.flight.lose_track(); }

/// Another steers. The vehicle still localizes and maps, and is ready to hover wherever it is.
void MissionControl::let_go(const std::string& reason) {
  onboard_.flight.let_go();
  if (phases_.in(Phase::manual) || emergency_) return;
  const bool looks = !onboard_.vehicle.lidar || earlier_map_.undecided() || !earlier_map_.refusal().empty();
  resumes_ = phases_.in(Phase::home) || phases_.in(Phase::land) ? phases_.phase()
             : phases_.in(Phase::explore) || !looks             ? Phase::explore
                                                                : Phase::look;
  path_.brake(now());  // nothing that was planned before is flown later
  onboard_.flight.hover_here(now());
  goals_.drop_next(GoalFate::superseded, reason, now());
  goals_.close_goal(GoalFate::superseded, reason, now());
  enter(Phase::manual, reason);
  if (standing_) wait_on_ground();  // it had not left the ground
}

/// As before the first take-off.
void MissionControl::wait_on_ground() {
  onboard_.flight.stand_down();
  enter(Phase::standby, "on the ground again");
}

void MissionControl::take_over() {
  if (emergency_) {
    onboard_.flight.take_over(now());
    return onboard_.flight.land_now(now(), kDoubtfulPath_m);
  }
  if (!phases_.in(Phase::manual)) return;
  forget_causes();
  path_.unblock();
  onboard_.flight.take_over(now());
  if (!flown_path_.begun()) {  // the pilot has taken off
    const Vec3 here = onboard_.flight.reference().position;
    flown_path_.begin(here);
    return_home_.set_home(home_after_hand_over(here));
  }
  if (const std::string lost = "the state estimate is lost: "; !sensors_.located_in_first_map())
    return land_here(lost + "its place in the first map is not known");
  // In the middle of its landing it may be too near to the ground to fly anywhere first.
  if (resumes_ == Phase::land && lands_at_home()) return enter(Phase::land, "the core steers again");
  if (resumes_ == Phase::home || resumes_ == Phase::land) return return_home_.begin("the core steers again");
  if (resumes_ == Phase::look && !onboard_.vehicle.lidar)
    onboard_.flight.look_around(now(), turn_to_see_all_around(onboard_.vehicle));
  enter(resumes_, "the core steers again");
}

/// Where the pilot handed over; or above the start, if that is outside of the region or too near to its
/// border.
Vec3 MissionControl::home_after_hand_over(const Vec3& here) const {
  const CoreOptions& o = onboard_.options;
  if (!o.region || o.region->depth_m(here) >= min_hover_depth_m(o)) return here;
  return onboard_.vehicle.T_world_start.position + Vec3(0, 0, o.mission.takeoff_height_m);
}

bool MissionControl::lands_at_home() const {
  constexpr double kBeside_m = 0.5;
  const Vec3 from_hover = onboard_.flight.state().position - return_home_.hover();
  return from_hover.head<2>().norm() < kBeside_m && from_hover.z() < kBeside_m;
}

MapQuestion MissionControl::map_question() const {
  MapQuestion question;
  const bool takes_off = phases_.in(Phase::takeoff);
  if (takes_off || phases_.under_way())  // during take-off the ground is near
    question.ahead = path_.ahead(now(), takes_off ? std::optional(take_off_.ground_m()) : std::nullopt);
  if (takes_off || traits_of(phases_.phase()).above_ground)
    question.descent_path = DescentQuery{
        onboard_.flight.until_stop(now()).points.back(),
        flown_path_.back(path_back_m(endurance_.battery_seconds_left())), onboard_.vehicle.radius_m,
        flown_path_.begun() ? std::optional(return_home_.hover()) : std::nullopt};
  question.narrow_places = path_.narrow_places();
  question.touch_only = path_.as_come();
  question.frontier = goals_.frontier();
  return question;
}

void MissionControl::on_map(const MapNews& news) {
  onboard_.recorder.map_changes(now(), news.changes);
  goals_.note_frontier(news.frontier, news.frontier_open);
  if (team_) team_->work.note_seen(news.bodies, news.stamp);
  onboard_.flight.prepare_landing(news.descent_path);
  if (news.blocked_after_m) leave_blocked_path(*news.blocked_after_m);
  steering_.on_map(news.seen_with);
}

void MissionControl::leave_blocked_path(double after_m) {
  if (path_.blocked() || onboard_.flight.at_rest(now())) return;
  if (phases_.in(Phase::takeoff) && take_off_.below_roof()) return;
  goals_.drop_next(GoalFate::unreachable, kPathForbidden, now());
  path_.avoid(after_m, phases_, now());
}

void MissionControl::keep_safe() {
  if (phases_.in(Phase::standby) || phases_.in(Phase::land) || phases_.in(Phase::done) ||
      phases_.in(Phase::manual))
    return sensors_.see_nothing_needed();
  const Flight& flight = onboard_.flight;
  SafetyObservation o;
  o.now = now();
  o.estimate = flight.estimator().diagnose(now());
  o.tracking_error_m = (flight.state().position - flight.reference().position).norm();
  if (phases_.under_way()) o.hull_clearance_m = sensors_.hull_clearance_m();  // not during lift-off
  o.blind_s = seconds(sensors_.blind_for());
  o.battery_s = endurance_.battery_seconds_left();
  if (const auto& region = onboard_.options.region; region && flown_path_.begun()) {
    const Vec3& here = flight.state().position;
    if (region->depth_m(here) < onboard_.vehicle.radius_m) o.outside = region->nearest_part(here);
  }
  const SafetyVerdict before = std::exchange(verdict_, safety_.judge(o));
  note_verdict(before);
  path_.obey(verdict_.action);
  react(before);
}

/// Records every change as an event, but only one if the same cause slows the vehicle and sends it home.
void MissionControl::note_verdict(const SafetyVerdict& before) {
  const auto note = [this](SafetyAction action, const std::string& reason) {
    onboard_.recorder.write(now(), event::Safety{action, reason});
  };
  const bool turns_back = verdict_.go_home && verdict_.go_home != before.go_home;
  if (!verdict_.same_motion(before) && !(turns_back && verdict_.reason == *verdict_.go_home))
    note(verdict_.action, verdict_.reason);
  if (turns_back) note(SafetyAction::home, *verdict_.go_home);
}

/// Brakes when a cause appears. The speed limit and permission to explore follow from the present causes: one
/// may have appeared or gone in a phase in which it had no effect.
void MissionControl::react(const SafetyVerdict& before) {
  const bool under_way = phases_.under_way();
  if (under_way) {
    // Above kTrusted_mps every scan counts.
    const bool sees_less =
        onboard_.load.sheds(Relief::half_the_scans) || onboard_.load.sheds(Relief::half_the_images);
    const double allowed_mps = path_.allowed_speed_mps(),
                 usual_mps = sees_less ? std::min(allowed_mps, kTrusted_mps) : allowed_mps;
    const auto unseen_mps = team_ ? team_->right_of_way.max_speed_mps() : std::nullopt;
    onboard_.flight.cap_speed(now(), std::min(usual_mps, unseen_mps.value_or(usual_mps)));
  }
  if (verdict_.action == SafetyAction::land) {
    path_.brake(now());
    return land_here(verdict_.reason);
  }
  if (verdict_.go_home && phases_.explores()) return_home_.begin(*verdict_.go_home);
  const bool brakes = verdict_.action == SafetyAction::brake && !verdict_.same_motion(before);
  if (brakes && under_way && !onboard_.flight.at_rest(now())) {
    goals_.drop_next(GoalFate::superseded, verdict_.reason, now());
    path_.brake(now());
    path_.block();  // then plans a new path from there
  }
}

void MissionControl::record() {
  const Flight& flight = onboard_.flight;
  const auto& battery = endurance_.battery();
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  onboard_.recorder.pose(flight.state());
  onboard_.recorder.telemetry({now(), phase(), flight.state(), flight.reference().position,
                               battery ? battery->fraction_left : kUnknown,
                               battery ? battery->seconds_left : kUnknown, sensors_.explored_m3(),
                               return_home_.distance_m()});
  if (const auto& m3 = sensors_.unsurveyed_m3()) onboard_.recorder.unsurveyed(now(), *m3);
  if (flown_path_.begun()) flown_path_.note(flight.reference().position);
  if (by_trust(onboard_.options.motion)) note_speed_limit();
  const bool each_second = now() % kSecond == 0;
  if (team_) team_->sharing.report(team_->right_of_way.phase_to_report());
  if (team_ && !emergency_ && each_second) {
    if (flown_path_.begun()) {
      team_->sharing.share();
      return_home_.give_way_at_landing();
    }
    objects_.note_at_base();
  }
  if (each_second && !onboard_.recorder.flush() && phases_.explores())
    return_home_.begin("the run directory cannot be written any more (disk full?)");
}

void MissionControl::note_speed_limit() {
  const Flight& flight = onboard_.flight;
  const SpeedLimit limit = phases_.under_way() ? flight.speed_limit(now()) : SpeedLimit::none;
  if (std::exchange(speed_limit_, limit) != limit)
    onboard_.recorder.write(now(), event::SpeedLimit{limit, flight.reference().velocity_mps.norm()});
}

void MissionControl::on_ground(TimeNs stamp) {
  standing_ = true;
  if (phases_.in(Phase::manual) && !flown_path_.begun()) {  // set down again before it was handed over
    return wait_on_ground();
  }
  const bool takes_off = !flown_path_.begun() && !phases_.in(Phase::land);  // it may touch the ground again
  if (!takes_off && !phases_.in(Phase::done)) touch_down(stamp);
}

void MissionControl::on_lift_off(TimeNs) {
  standing_ = false;
  if (phases_.in(Phase::standby) && authority_ != Authority::core) let_go("the pilot takes off");
}

void MissionControl::switch_off_motors(TimeNs stamp) {
  onboard_.flight.disarm();
  vehicle_.command(onboard_.flight.control(stamp));
}

/// Stops the motors before anything else: a vehicle that has lost its pose would never land again.
void MissionControl::touch_down(TimeNs stamp) {
  switch_off_motors(stamp);
  try {
    finish_on_ground();
  } catch (...) {  // it has landed, even if this cannot be recorded
    if (!result_) result_ = MissionResult{MissionOutcome::aborted, "", true, ""};
    throw;
  }
}

void MissionControl::finish_on_ground() {
  const std::optional<LandingSpot> spot = return_home_.landing_spot();
  const Vec3 there = spot ? spot->ground : onboard_.vehicle.T_world_start.position;
  const double off_m = (onboard_.flight.state().position - there).head<2>().norm();
  const std::string place = std::to_string(off_m).substr(0, 5) + " m from the start";
  if (emergency_)
    finish(MissionOutcome::aborted, *emergency_ + ": on the ground " + place);
  else if (phases_.in(Phase::manual))
    finish(MissionOutcome::aborted, std::string("landed by the ") + name_of(authority_) + ", " + place);
  else if (!phases_.in(Phase::land))
    finish(MissionOutcome::contact, std::string("touched the ground in phase ") + name_of(phase()));
  else if (off_m < 1.0)
    finish(MissionOutcome::landed, spot ? "as a relay" : "at the start");
  else
    finish(MissionOutcome::stuck, "on the ground " + place);
}

void MissionControl::on_lost(TimeNs, MissionOutcome outcome, const std::string& reason) {
  finish(outcome, reason);
}

}  // namespace karst::core
