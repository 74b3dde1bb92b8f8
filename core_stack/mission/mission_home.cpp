// Going home while the battery still lasts for it, and landing.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core_stack/homing/home.h"
#include "core_stack/mission/mission_control.h"

namespace karst::core {
namespace {

constexpr double kAboveHome_m = 0.4;
constexpr int kMostHomeFailures = 3;
constexpr TimeNs kPlanningBudget = 300 * kMillisecond;
constexpr TimeNs kEstimateBudget = 100 * kMillisecond;
// Without progress, it lands where it is. A cave that shuts it in does not open again while it hovers, and
// the dust under a hovering vehicle does not settle; another vehicle goes away.
constexpr TimeNs kPatience = 12 * kSecond, kPatienceInCompany = 60 * kSecond;
constexpr TimeNs kAgain = kSecond;

}  // namespace

double MissionControl::seconds_left() const {
  return std::min(battery_.seconds_left, options_.mission.max_flight_time_s - seconds(now()));
}

void MissionControl::begin_homing(const std::string& reason) {
  drop_next_goal(PolicyEvent::Kind::goal_superseded, "going home");
  settle_goal(GoalFate::superseded, PolicyEvent::Kind::goal_superseded, "going home");
  events_.push_back({PolicyEvent::Kind::homing, now(), {}, reason});
  executive_.job(
      "farewell", Lane::map, kEstimateBudget,
      [this, events = std::exchange(events_, {}), stamp = now()] { explorer_.tell(events, stamp); }, [] {});
  detour_due_ = !path_blocked_;  // whatever is under way leads elsewhere
  enter(Phase::home, reason);
  homing_reason_ = reason;
  if (team_) claim_goal(std::nullopt);
  if (team_ && team_->lands_as_relay()) choose_landing();
}

void MissionControl::watch_battery() {
  if (now() % kSecond != 0) return;
  auto estimate = std::make_shared<HomeEstimate>();
  executive_.job(
      "home estimate", Lane::map, kEstimateBudget,
      [this, estimate, from = flight_.reference().position, come_m = flown_m_] {
        *estimate = explorer_.estimate_home(from, come_m);
      },
      [this, estimate] {
        if (phase_ != Phase::explore) return;
        home_distance_m_ = estimate->length_m;
        const double slack_s = home_slack_s(seconds_left(), estimate->time_s, options_.mission.home_margin,
                                            options_.mission.home_reserve_s);
        if (!turn_back_.due(slack_s)) return;
        recorder_.event(now(), "homing",
                        {{"reason", seconds_left() < battery_.seconds_left ? "time limit" : "battery"},
                         {"distance", home_distance_m_},
                         {"seconds_left", seconds_left()},
                         {"seconds_needed", seconds_left() - slack_s}});
        begin_homing("the time left only just suffices for the way home");
      });
}

void MissionControl::go_home() {
  if (verdict_.action == SafetyAction::brake) {
    last_landmark_time_ = now();  // it does not wait for a way, but for what it is to see or to follow
    return;
  }
  if (home_planning_) return;
  if (encounter_.holds()) {
    last_landmark_time_ = now();
    unheard_since_.reset();
    return;
  }
  const bool at_home = (flight_.reference().position - landing_hover()).norm() < kAboveHome_m;
  if (!at_home && landing_again_ && now() >= *landing_again_) return choose_landing();
  if (at_home && flight_.at_rest(now() - kSecond)) {
    if (landing_) return confirm_landing();
    enter(Phase::land, "");
  } else if (path_blocked_ || detour_due_ || (!at_home && flight_.at_rest(now()))) {
    if (home_failures_ < kMostHomeFailures) {
      if (now() >= home_retry_) plan_home_path();
    } else if (landing_) {
      give_up_landing("there is no way there");
    } else if (flight_.at_rest(now())) {
      fly_back_as_come();
    }
  }
  if ((flight_.reference().position - last_landmark_).norm() > 0.5) {
    last_landmark_ = flight_.reference().position;
    last_landmark_time_ = now();
  } else if (!at_home && now() - last_landmark_time_ > (in_company() ? kPatienceInCompany : kPatience)) {
    constexpr const char* kReason = "no way home, and waiting does not help";
    recorder_.event(now(), "safety", {{"action", "land"}, {"reason", kReason}});
    enter(Phase::land, kReason);
  }
}

void MissionControl::plan_home_path() {
  home_planning_ = true;
  const TimeNs start = now() + kPlanningBudget;
  const Flight::Onward lead = flight_.until_stop(start);
  auto way = std::make_shared<Route>();
  executive_.job(
      "home plan", Lane::map, kPlanningBudget,
      [this, way, lead, start, home = landing_hover(), limits = flight_.limits(0), narrow = narrow_places_] {
        const Path path = explorer_.plan_to(lead.points.back(), home);
        way->path = path;
        if (path.found())
          *way = route(lead, path, std::nullopt, std::nullopt, start, kMostCut_m, limits, narrow);
      },
      [this, way, begun = now()] {
        home_planning_ = false;
        if (phase_ != Phase::home || braked_since(begun) || encounter_.holds()) return;
        if (!way->path.found()) {
          if (in_company())
            home_retry_ = now() + kAgain;  // it makes room
          else
            ++home_failures_;
          path_blocked_ = true;
          detour_due_ = false;
          recorder_.event(now(), "log", {{"text", "no path home: " + way->path.reason}});
          if (!flight_.at_rest(now())) brake();
          return;
        }
        flying_as_come_ = false;
        follow(*way);
      });
}

/// The way come was flown without touching anything.
void MissionControl::fly_back_as_come() {
  home_planning_ = true;
  auto way = std::make_shared<Route>();
  std::vector<Vec3> flown = flown_;
  flown.push_back(flight_.reference().position);
  executive_.job(
      "way back", Lane::map, kPlanningBudget,
      [this, way, flown = std::move(flown), lead = flight_.until_stop(now()), limits = flight_.limits(0),
       narrow = narrow_places_] {
        Path back;
        back.points = explorer_.way_back(flown);
        *way = route(lead, back, std::nullopt, std::nullopt, 0, kMostCut_m, limits, narrow);
      },
      [this, way, begun = now()] {
        home_planning_ = false;
        if (phase_ != Phase::home || braked_since(begun) || encounter_.holds()) return;
        recorder_.event(now(), "safety",
                        {{"action", "home"}, {"reason", "no path through the map: back the way it came"}});
        follow(*way);
        flying_as_come_ = true;
        home_failures_ = 0;
      });
}

void MissionControl::land() {
  if (standing_) return touch_down(now());  // it had not left the ground yet
  if (!flight_.at_rest(now())) return;
  // Down until the ground is felt; the height above it is not known to better than the map.
  flight_.climb(now(), -(options_.mission.takeoff_height_m + 0.5), options_.mission.landing_speed_mps);
}

}  // namespace karst::core
