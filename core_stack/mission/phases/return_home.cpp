#include "core_stack/mission/phases/return_home.h"

#include <utility>

namespace karst::core {
namespace {

constexpr double kAboveHome_m = 0.4, kSamePlace_m = 1.0;
// Failed plans in a row. The obstacle may be another vehicle, or the last known place of one that has left.
constexpr int kMaxFailures = 3, kMaxFailuresInCompany = 4;
constexpr double kMuchShorter = 0.8;  // than the path through the map, to be flown as come
constexpr TimeNs kPlanningBudget = 300 * kMillisecond;
constexpr TimeNs kEstimateBudget = 100 * kMillisecond;
// Without progress the vehicle lands where it is. A blocked cave does not open while it hovers, and dust
// below a hovering vehicle does not settle; another vehicle, however, moves on.
constexpr TimeNs kPatience = 12 * kSecond, kPatienceInCompany = 60 * kSecond;
constexpr TimeNs kAgain = kSecond;

/// The flown path backwards from where the vehicle can stop, its loops cut.
Path as_come(const Explorer& explorer, std::vector<Vec3> flown, const RouteStart& start) {
  flown.insert(flown.end(), start.committed.points.begin(), start.committed.points.end());
  Path back;
  back.points = explorer.path_back(flown);
  return back;
}

}  // namespace

const Vec3& ReturnHome::hover() const {
  return parts_.landing && parts_.landing->spot() ? parts_.landing->spot()->hover : home_;
}

std::optional<LandingSpot> ReturnHome::landing_spot() const {
  return parts_.landing ? parts_.landing->spot() : std::nullopt;
}

void ReturnHome::set_home(const Vec3& hover) {
  home_ = hover;
  onboard_.map.job("home", kMappingBudget, [hover](Explorer& explorer) { explorer.set_home(hover); });
}

void ReturnHome::begin(const std::string& reason) {
  const TimeNs now = onboard_.now();
  parts_.goals.drop_next(GoalFate::superseded, "going home", now);
  parts_.goals.close_goal(GoalFate::superseded, "going home", now);
  parts_.goals.note_homing(reason, now);
  onboard_.map.job(
      "farewell", kEstimateBudget,
      [events = parts_.goals.take_events(), now](Explorer& explorer) { explorer.tell(events, now); });
  parts_.path.ask_for_detour();
  wiring_.enter(Phase::home, reason);
  still_.restart(onboard_.flight.reference().position, now);
  if (reason_.empty()) reason_ = reason;
  chose_as_come_ = false;
  wiring_.give_up_goals();
  if (parts_.landing) choose_landing();
}

void ReturnHome::watch_time() {
  if (onboard_.now() % kSecond != 0 || onboard_.executive.under_way("home estimate") > 1) return;
  onboard_.map.job(
      "home estimate", kEstimateBudget,
      [from = onboard_.flight.reference().position, come_m = parts_.flown_path.length_m()](
          Explorer& explorer) { return explorer.estimate_home(from, come_m); },
      [this](const HomeEstimate& estimate) { on_estimate(estimate); });
}

void ReturnHome::on_estimate(const HomeEstimate& estimate) {
  if (!parts_.phases.explores()) return;
  const MissionOptions& o = onboard_.options.mission;
  const double seconds_left = parts_.endurance.seconds_left(onboard_.now());
  distance_m_ = estimate.length_m;
  const double slack_s = home_slack_s(seconds_left, estimate.time_s, o.home_margin, o.home_reserve_s);
  if (leads_too_far(estimate)) return;
  if (!return_trigger_.due(slack_s)) return;
  const bool by_time = seconds_left < parts_.endurance.battery_seconds_left();
  onboard_.recorder.write(onboard_.now(), event::Homing{by_time ? "time limit" : "battery", distance_m_,
                                                        seconds_left, seconds_left - slack_s});
  begin(by_time ? "the time allowed only just suffices for the way home"
                : "the battery only just suffices for the way home");
}

/// Goals and paths keep the limit; but a passage may turn out closed, and the vehicle may drift.
bool ReturnHome::leads_too_far(const HomeEstimate& estimate) {
  constexpr double kTolerance_m = 1;
  const auto& region = onboard_.options.region;
  if (!region || !region->limits().max_home_m || !estimate.by_map ||
      estimate.length_m <= *region->limits().max_home_m + kTolerance_m)
    return false;
  constexpr const char* kReason = "the way home is longer than region.max_home_distance";
  onboard_.recorder.write(onboard_.now(), event::Safety{SafetyAction::home, kReason});
  begin(kReason);
  return true;
}

void ReturnHome::step() {
  const TimeNs now = onboard_.now();
  if (parts_.path.held())
    return still_.wait(now);  // it waits for sensors or for its trajectory, not for a path
  if (planning_) return;
  if (parts_.path.yields()) {
    if (parts_.landing) parts_.landing->stop_listening();
    return still_.wait(now);
  }
  const bool at_home = (onboard_.flight.reference().position - hover()).norm() < kAboveHome_m;
  if (!at_home && parts_.landing && parts_.landing->look_again_due()) return choose_landing();
  if (at_home && onboard_.flight.at_rest(now - kSecond)) {
    if (landing_spot()) return arrive();
    wiring_.enter(Phase::land, "");
  } else if (parts_.path.blocked() || parts_.path.detour_due() ||
             (!at_home && onboard_.flight.at_rest(now))) {
    find_path();
  }
  watch_patience(at_home);
}

/// The vehicle hovers above its landing site.
void ReturnHome::arrive() {
  std::string why;
  switch (parts_.landing->listen(why)) {
    case RelayLanding::Heard::lands:
      return wiring_.enter(Phase::land, why);
    case RelayLanding::Heard::nobody:
      return give_up_landing("nobody who reaches the base is heard there", RelayLanding::Because::no_contact);
    case RelayLanding::Heard::waits:
      return;
  }
}

void ReturnHome::find_path() {
  const TimeNs now = onboard_.now();
  if (failures_ < max_failures()) {
    if (now >= retry_) plan();
  } else if (landing_spot()) {
    give_up_landing("there is no way there", RelayLanding::Because::not_to_be_had);
  } else if (onboard_.flight.at_rest(now)) {
    if (blocked_on_the_way_back())
      look_around();
    else
      fly_back_as_come();
  }
}

int ReturnHome::max_failures() const { return wiring_.in_company() ? kMaxFailuresInCompany : kMaxFailures; }

/// Whether a vehicle whose cameras see one side has just set out from here, and come to rest again.
bool ReturnHome::blocked_on_the_way_back() const {
  return !onboard_.vehicle.lidar && set_out_from_ &&
         (onboard_.flight.reference().position - *set_out_from_).norm() < kSamePlace_m;
}

/// What is in the way may have left since the cameras looked there: afterwards one more plan is made. To look
/// is not to wait: patience begins anew when the turn ends.
void ReturnHome::look_around() {
  set_out_from_.reset();
  failures_ = max_failures() - 1;
  const double turn_rad = turn_to_see_all_around(onboard_.vehicle);
  onboard_.flight.look_around(onboard_.now(), turn_rad);
  retry_ = onboard_.flight.trajectory_end();
  still_.wait(retry_);
}

void ReturnHome::watch_patience(bool at_home) {
  const TimeNs now = onboard_.now();
  const TimeNs still = still_.still_for(onboard_.flight.reference().position, now);
  if (wiring_.in_company()) company_at_ = now;
  const bool waits_in_vain = still > kPatience && now - company_at_ > kPatience;
  if (at_home || !(waits_in_vain || still > kPatienceInCompany)) return;
  constexpr const char* kReason = "no way home, and waiting does not help";
  onboard_.recorder.write(now, event::Safety{SafetyAction::land, kReason});
  wiring_.land_here(kReason);
}

/// Plans through the map. A passage that has closed in the map may leave only a long way round: where the
/// battery does not last for it, the vehicle flies back as it came, once, if that is a good deal shorter and
/// the map shows nothing that it would touch. In a team the passage may be closed by another vehicle, which
/// moves on; with a region the flown path may lie outside.
void ReturnHome::plan() {
  planning_ = true;
  const TimeNs begun = onboard_.now();
  const bool may_fly_as_come =
      !chose_as_come_ && !landing_spot() && !wiring_.in_company() && !onboard_.options.region;
  onboard_.map.job(
      "home plan", kPlanningBudget,
      [this, start = start(begun + kPlanningBudget), to = hover(), may_fly_as_come,
       flown = may_fly_as_come ? parts_.flown_path.points() : std::vector<Vec3>{},
       lasting_m = lasting_length_m()](Explorer& explorer) mutable {
        WayHome way;
        Path path = explorer.plan_to(start.committed.points.back(), to);
        if (!path.found()) {
          way.route.path = std::move(path);
          return way;
        }
        const double length_m = path_length_m(path.points);
        if (may_fly_as_come && length_m > lasting_m) {
          Path back = as_come(explorer, std::move(flown), start);
          way.as_come = path_length_m(back.points) < kMuchShorter * length_m &&
                        explorer.touching_segment(back.points) < 0;
          if (way.as_come) path = std::move(back);
        }
        if (way.as_come) start.at = 0;  // no polynomial for it
        way.route = make_route(explorer.map(), onboard_.options, onboard_.vehicle, start, path, {});
        return way;
      },
      [this, begun](const WayHome& way) { on_plan(way, begun); });
}

/// The longest way home for which the battery lasts, by the estimate that turns the vehicle back, and without
/// its reserve: the vehicle lands wherever it is before the battery is empty.
double ReturnHome::lasting_length_m() const {
  const CoreOptions& o = onboard_.options;
  const double seconds_left = parts_.endurance.battery_seconds_left() - o.safety.battery_land_s,
               cruise_mps = cruise_speed_mps(o.motion),
               start_and_stop_s = cruise_mps / o.motion.max_acceleration_mps2,
               descent_s = home_time_s(0, onboard_.vehicle.T_world_start.position.z(), home_.z(), o.motion,
                                       o.mission.landing_speed_mps);
  return cruise_mps * (seconds_left / (1 + o.mission.home_margin) - start_and_stop_s - descent_s);
}

void ReturnHome::on_plan(const WayHome& way, TimeNs begun) {
  planning_ = false;
  const TimeNs now = onboard_.now();
  PathExecution& path = parts_.path;
  if (!parts_.phases.in(Phase::home) || path.outdated(begun)) return;
  if (way.as_come) {
    chose_as_come_ = true;
    return follow_as_come(way.route, "the battery does not last for the path through the map");
  }
  if (way.route.path.found()) {
    failures_ = 0;
    return path.follow(way.route, now);
  }
  ++failures_;
  if (wiring_.in_company()) retry_ = now + kAgain;  // the other vehicle makes room
  path.block();
  path.take_no_detour();
  onboard_.recorder.write(now, event::Log{"no path home: " + way.route.path.reason});
  path.stop(now);
}

/// Follows the flown path, which was passed without contact.
void ReturnHome::follow_as_come(const Route& route, const std::string& why) {
  const TimeNs now = onboard_.now();
  onboard_.recorder.write(now, event::Safety{SafetyAction::home, why + ": back the way it came"});
  parts_.path.follow(route, now);
  parts_.path.fly_as_come();
  set_out_from_ = onboard_.flight.reference().position;
  failures_ = onboard_.vehicle.lidar ? 0 : max_failures() - 1;
}

void ReturnHome::fly_back_as_come() {
  planning_ = true;
  const TimeNs begun = onboard_.now();
  RouteStart from_here = start(begun);
  from_here.at = 0;  // no polynomial for it
  onboard_.map.job(
      "way back", kPlanningBudget,
      [this, flown = parts_.flown_path.points(), from_here](Explorer& explorer) {
        return make_route(explorer.map(), onboard_.options, onboard_.vehicle, from_here,
                          as_come(explorer, flown, from_here), {});
      },
      [this, begun](const Route& route) {
        planning_ = false;
        if (!parts_.phases.in(Phase::home) || parts_.path.outdated(begun)) return;
        follow_as_come(route, "no path through the map");
      });
}

void ReturnHome::choose_landing() {
  planning_ = true;
  parts_.landing->choose(
      parts_.flown_path.length_m(), [this] { planning_ = false; },
      [this] {
        failures_ = 0;
        parts_.path.ask_for_detour();
      });
}

void ReturnHome::give_up_landing(const std::string& reason, RelayLanding::Because because) {
  parts_.landing->give_up(reason, because);
  choose_landing();
}

void ReturnHome::give_way_at_landing() {
  if (parts_.landing && parts_.phases.in(Phase::home) && parts_.landing->overruled())
    give_up_landing("another claimed it before", RelayLanding::Because::not_to_be_had);
}

}  // namespace karst::core
