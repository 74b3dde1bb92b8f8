// Going home while the battery still lasts for it, and landing.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "core_stack/mission/mission_control.h"

namespace karst::core {
namespace {

constexpr double kAboveHome_m = 0.4;
constexpr int kMostHomeFailures = 3;
constexpr TimeNs kPlanningBudget = 300 * kMillisecond;
constexpr TimeNs kEstimateBudget = 100 * kMillisecond;
constexpr TimeNs kPatience = 60 * kSecond;
constexpr double kLandAnywhere_s = 12.0;   // battery time at which the vehicle lands wherever it is
constexpr double kReturnSpeedShare = 0.5;  // of max_speed, when no better estimate of the way home exists

}  // namespace

void MissionControl::watch_battery() {
  if (now() % kSecond != 0) return;
  auto estimate = std::make_shared<HomeEstimate>();
  executive_.job(
      "home estimate", Lane::map, kEstimateBudget,
      [this, estimate, from = flight_.reference().position] { *estimate = explorer_.estimate_home(from); },
      [this, estimate] {
        if (phase_ != Phase::explore) return;
        if (!estimate->length_m) {  // no way through the map: count the way come
          estimate->length_m = path_length_m(flown_);
          estimate->time_s = *estimate->length_m / (kReturnSpeedShare * options_.motion.max_speed_mps);
        }
        home_distance_m_ = *estimate->length_m;
        const double needed_s =
            estimate->time_s * (1 + options_.mission.home_margin) + options_.mission.home_reserve_s;
        const double time_s = seconds(now()), limit_s = options_.mission.max_flight_time_s;
        if (battery_.seconds_left > needed_s && time_s + needed_s < limit_s) return;
        recorder_.event(now(), "homing",
                        {{"reason", time_s + needed_s < limit_s ? "battery" : "time limit"},
                         {"distance", home_distance_m_},
                         {"seconds_left", battery_.seconds_left},
                         {"seconds_needed", needed_s}});
        enter(Phase::home, "the time left only just suffices for the way home");
      });
}

void MissionControl::go_home() {
  if (goal_ || next_goal_) {
    next_goal_.reset();
    settle_goal(GoalFate::superseded, PolicyEvent::Kind::homing, "going home");
    path_blocked_ = true;  // whatever was under way, a new path is due
  }
  if (battery_.seconds_left < kLandAnywhere_s) {
    recorder_.event(now(), "safety", {{"action", "land"}, {"reason", "the battery ends"}});
    flight_.brake(now());
    enter(Phase::land, "the battery ends");
    return;
  }
  if (home_planning_) return;
  const bool at_home = (flight_.reference().position - explorer_.home()).norm() < kAboveHome_m;
  if (at_home && flight_.at_rest(now() - kSecond)) {
    enter(Phase::land, "");
  } else if (path_blocked_ || (!at_home && flight_.at_rest(now()))) {
    if (home_failures_ < kMostHomeFailures) {
      plan_home_path();
    } else {
      fly_back_as_come();
    }
  }
  if ((flight_.reference().position - last_landmark_).norm() > 0.5) {
    last_landmark_ = flight_.reference().position;
    last_landmark_time_ = now();
  } else if (!at_home && now() - last_landmark_time_ > kPatience) {
    recorder_.event(now(), "safety", {{"action", "land"}, {"reason", "no way home for a minute"}});
    enter(Phase::land, "no way home for a minute");
  }
}

void MissionControl::plan_home_path() {
  home_planning_ = true;
  const Flight::Onward lead = flight_.until_stop(now() + kPlanningBudget);
  const bool resting = flight_.at_rest(now());
  auto path = std::make_shared<Path>();
  executive_.job(
      "home plan", Lane::map, kPlanningBudget,
      [this, path, from = lead.points.back()] { *path = explorer_.plan_to(from, explorer_.home()); },
      [this, path, lead, resting] {
        home_planning_ = false;
        if (phase_ != Phase::home) return;
        if (!path->found()) {
          ++home_failures_;
          path_blocked_ = true;
          recorder_.event(now(), "log", {{"text", "no path home: " + path->reason}});
          if (!flight_.at_rest(now())) flight_.brake(now());
          return;
        }
        std::vector<Vec3> points = lead.points;
        points.insert(points.end(), path->points.begin() + 1, path->points.end());
        HeadingPlan heading;
        heading.along_path = !description_.lidar;
        heading.start_heading_rad = lead.heading_rad;
        flight_.follow(points, resting ? 0.0 : lead.speed_mps, now(), heading);
        path_blocked_ = false;
        nlohmann::json list = nlohmann::json::array();
        for (const Vec3& p : points) list.push_back({p.x(), p.y(), p.z()});
        recorder_.event(now(), "plan",
                        {{"length", path_length_m(points)},
                         {"from", list.front()},
                         {"to", list.back()},
                         {"points", list}});
      });
}

void MissionControl::fly_back_as_come() {
  // The way come was flown without touching anything: follow it back, cutting off its loops.
  std::vector<Vec3> back{flight_.reference().position};
  std::size_t i = flown_.size();
  while (i > 0) {
    // The earliest pose within reach of a step shortens the way most.
    const Vec3 here = back.back();
    const auto near = std::find_if(flown_.begin(), flown_.begin() + static_cast<std::ptrdiff_t>(i),
                                   [&](const Vec3& p) { return (p - here).norm() < 0.6; });
    i = static_cast<std::size_t>(near - flown_.begin());
    if (near == flown_.begin() + static_cast<std::ptrdiff_t>(flown_.size())) break;
    if (i > 0) --i;
    back.push_back(flown_[i]);
    if (i == 0) break;
  }
  back.push_back(explorer_.home());
  HeadingPlan keep;
  keep.along_path = !description_.lidar;
  keep.start_heading_rad = flight_.reference().heading_rad;
  flight_.follow(back, 0, now(), keep);
  ignore_blocks_ = true;
  path_blocked_ = false;
  home_failures_ = 0;
  recorder_.event(now(), "safety",
                  {{"action", "home"}, {"reason", "no path through the map: back the way it came"}});
}

void MissionControl::land() {
  if (!flight_.at_rest(now())) return;
  // Down until the ground is felt; the height above it is not known to better than the map.
  flight_.climb(now(), -(options_.mission.takeoff_height_m + 0.5), options_.mission.landing_speed_mps);
}

}  // namespace karst::core
