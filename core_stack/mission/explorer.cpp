#include "core_stack/mission/explorer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core_stack/homing/home.h"
#include "core_stack/planning/free_tiles.h"
#include "core_stack/planning/grid_planner.h"
#include "core_stack/planning/planner.h"

namespace karst::core {
namespace {

/// A round tries no more plans than this: the rest of a ranked list waits for the next round.
constexpr int kMostPlans = 5;
/// A vehicle that stands for so long, because the policy holds it or because none of its goals can be
/// accepted, gets its next goal from the fallback.
constexpr TimeNs kMostIdle = 2 * kSecond;
/// A path under way is judged a little milder than a new one, or noise would stop every flight.
constexpr double kClearanceSlack_m = 0.12;
/// A cluster that has lost this share of its cells has been seen; flying on to it is a waste.
constexpr double kSeenShare = 0.75;

/// Way back: poses nearer than this are joined directly, if the line is clear by this much beyond the radius.
constexpr double kShortcut_m = 2.0, kShortcutMargin_m = 0.15;

constexpr const char* kTooFar = "the battery, or the time allowed, does not last for going there and home";

/// Pauses of places tried in vain that are waived when no other place is left: the first three attempts'.
constexpr TimeNs kPauseWaived = 40 * kSecond;

double elapsed_ms(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
}

}  // namespace

Explorer::Explorer(const CoreOptions& options, const VehicleDescription& vehicle, PolicyPort& policy)
    : options_(options),
      vehicle_(vehicle),
      view_(steepest_view(vehicle)),
      policy_(&policy),
      map_(options.map),
      frontiers_(options.frontiers),
      roadmap_(options.planning),
      home_(vehicle.T_world_start.position + Vec3(0, 0, options.mission.takeoff_height_m)) {}

std::vector<CellChange> Explorer::integrate(const std::vector<Ray>& rays) {
  return take_in(map_.insert(rays));
}

std::vector<CellChange> Explorer::declare_launch_site(const Vec3& hover_point) {
  return take_in(map_.declare_free(hover_point, options_.mission.launch_clear_radius_m));
}

std::vector<CellChange> Explorer::take_in(std::vector<CellChange> changes) {
  frontiers_.update(map_, changes);
  roadmap_due_.insert(roadmap_due_.end(), changes.begin(), changes.end());
  return changes;
}

const Roadmap& Explorer::roadmap() {
  roadmap_.update(map_, roadmap_due_);
  roadmap_due_.clear();
  way_home_.update(map_, roadmap_, home_, options_.planning);
  return roadmap_;
}

std::optional<double> Explorer::hull_clearance_m(const Vec3& p) const {
  const double limit_m = vehicle_.radius_m + 0.5;
  FreeTiles free(map_.resolution_m());
  free.load_near(map_, p, limit_m);
  const double distance_m = free.nearest(p, limit_m).distance_m - map_.resolution_m() / 2;
  if (distance_m >= limit_m - map_.resolution_m()) return std::nullopt;
  return distance_m - vehicle_.radius_m;
}

bool Explorer::cluster_alive(std::uint32_t id) const {
  const auto it = frontiers_.clusters().find(id);
  if (it == frontiers_.clusters().end()) return false;
  const auto chosen = chosen_.find(id);
  return chosen == chosen_.end() || static_cast<double>(it->second.cells.size()) >=
                                        (1 - kSeenShare) * static_cast<double>(chosen->second.cells);
}

Decision Explorer::ask(const DecisionRequest& request, RoundResult& result) {
  const bool idle_too_long = idle_since_ && request.stamp - *idle_since_ >= kMostIdle;
  if (!policy_failed_ && !idle_too_long) {
    try {
      result.policy = policy_->name();
      return policy_->decide(request);
    } catch (const PolicyFailure& failure) {
      policy_failed_ = true;
      result.policy_failure = failure.what();
    }
  }
  result.policy = fallback_.name();
  idle_since_.reset();
  return fallback_.decide(request);
}

std::optional<std::string> Explorer::objection(const Goal& goal) const {
  const Vec3& p = goal.position;
  if (!p.allFinite()) return "its position is not finite";
  if (std::isinf(goal.heading_rad)) return "its heading is not finite";
  if (map_.at(p) != Cell::free)
    return map_.at(p) == Cell::occupied ? "it lies in an occupied cell" : "it lies in unknown space";
  if (!is_clear(map_, p, options_.planning.clearance_m)) return "it is too near to rock or unknown space";
  if (const auto why = ledger_.closed(map_, p, closed_at_)) return "it was tried before: " + *why;
  return std::nullopt;
}

HomeEstimate Explorer::estimate_home(const Vec3& from, double way_come_m) {
  const double length_m = way_home_.length_m(map_, roadmap(), from).value_or(way_come_m);
  return {length_m, home_time_s(length_m, vehicle_.T_world_start.position.z(), home_.z(), options_.motion,
                                options_.mission.landing_speed_mps)};
}

std::vector<Vec3> Explorer::way_back(const std::vector<Vec3>& flown) const {
  std::vector<Vec3> back;
  const double clearance_m = vehicle_.radius_m + kShortcutMargin_m;
  for (std::size_t i = flown.size(); i-- > 0;) {
    back.push_back(flown[i]);
    // The earliest pose that can be joined shortens the way most. To the one before leads what was flown.
    for (std::size_t j = 0; j + 1 < i; ++j)
      if ((flown[j] - flown[i]).norm() < kShortcut_m &&
          segment_clear(map_, flown[i], flown[j], clearance_m)) {
        i = j + 1;
        break;
      }
  }
  back.push_back(home_);
  return back;
}

void Explorer::choose(const RoundInput& input, const std::vector<Goal>& goals, RoundResult& result) {
  int plans = 0;
  for (const Goal& goal : goals) {
    if (plans == kMostPlans) break;
    std::string why;
    if (const auto problem = objection(goal)) {
      why = *problem;
    } else {
      ++plans;
      const Path path = plan(map_, roadmap_, input.from, goal.position, options_.planning);
      const auto blind = path.found() ? blind_climb(view_, input.way_come, path.points) : std::nullopt;
      if (blind) {
        why = *blind;
        ledger_.close(map_, goal.position, input.now, why);
      } else if (path.found()) {
        const HomeEstimate home = estimate_home(goal.position, input.way_come_m + path.length_m);
        const double there_s = flight_time_s(path.length_m, options_.motion);
        if (home_slack_s(input.seconds_left - there_s, home.time_s, options_.mission.home_margin,
                         options_.mission.home_reserve_s) > 0) {
          result.goal = goal;
          result.path = path;
          if (goal.frontier_id != 0) {
            const auto cluster = frontiers_.clusters().find(goal.frontier_id);
            if (cluster != frontiers_.clusters().end() &&
                (!input.last_goal || input.last_goal->frontier_id != goal.frontier_id))
              chosen_[goal.frontier_id] = {cluster->second.cells.size(), cluster->second.centroid};
          }
          return;
        }
        why = kTooFar;
      } else {
        why = "no path: " + path.reason;
        ledger_.close(map_, goal.position, input.now, why);
      }
    }
    result.rejected.push_back({goal, why});
  }
}

void Explorer::tell(const std::vector<PolicyEvent>& events, TimeNs now) {
  for (const PolicyEvent& event : events) {
    if (!policy_failed_) policy_->notify(event);
    if (event.kind == PolicyEvent::Kind::goal_abandoned)
      ledger_.close(map_, event.goal.position, now, event.reason);
  }
}

RoundResult Explorer::decide(const RoundInput& input) {
  RoundResult result;
  const auto begin = std::chrono::steady_clock::now();
  tell(input.events, input.now);
  // What was looked at and opens again right there is mostly noise at a wall: it may wait.
  for (const std::uint32_t id : input.looked_at)
    if (const auto chosen = chosen_.find(id); chosen != chosen_.end())
      ledger_.close(map_, chosen->second.centroid, input.now, "looked at a short while ago");
  roadmap();  // up to date from here on: the map does not change within a round

  DecisionRequest request;
  request.stamp = input.now;
  request.deadline = input.deadline;
  request.sequence = ++sequence_;
  request.state = input.state;
  request.direction_of_flight = input.direction;
  request.T_world_start = vehicle_.T_world_start;
  const HomeEstimate home = estimate_home(input.from, input.way_come_m);
  request.seconds_before_homing = home_slack_s(input.seconds_left, home.time_s, options_.mission.home_margin,
                                               options_.mission.home_reserve_s);
  request.max_speed_mps = options_.motion.max_speed_mps;
  request.clearance_m = options_.planning.clearance_m;
  request.vehicle_radius_m = vehicle_.radius_m;
  request.last_fate = input.last_fate;
  if (input.last_goal) request.last_goal = input.last_goal->position;
  request.map = &map_;
  request.roadmap = &roadmap_;
  request.vehicle = &vehicle_;
  closed_at_ = input.now;
  request.frontiers = offers(input);
  if (request.frontiers.empty()) {  // nothing else is left: no need to wait with what was tried a few times
    closed_at_ += kPauseWaived;
    request.frontiers = offers(input);
  }

  const auto asked = std::chrono::steady_clock::now();
  Decision decision = ask(request, result);
  result.decide_ms = elapsed_ms(asked);
  result.outcome = decision.outcome;
  result.reason = decision.reason;
  result.drawings = std::move(decision.drawings);
  result.log.insert(result.log.end(), decision.log.begin(), decision.log.end());
  result.goals_proposed = decision.goals.size();
  std::size_t own_rejections = 0;
  if (decision.outcome == Outcome::goals) {
    choose(input, decision.goals, result);
    // Waiting brings no battery back: goals that are all too far are no reason to stand and ask again.
    const bool all_too_far =
        !result.rejected.empty() && std::all_of(result.rejected.begin(), result.rejected.end(),
                                                [](const RejectedGoal& r) { return r.reason == kTooFar; });
    own_rejections = result.rejected.size();
    if (!result.goal && all_too_far && result.policy != fallback_.name()) {
      result.policy = fallback_.name();
      choose(input, fallback_.decide(request).goals, result);
    }
    if (!result.goal) {
      // The fallback asks for every frontier in reach: if none of those can be flown to, nothing is left to
      // do.
      const bool last_resort = result.policy == fallback_.name();
      result.outcome = last_resort ? Outcome::explored : Outcome::hold;
      result.out_of_time = last_resort && all_too_far;
      result.reason = result.out_of_time ? "what is left is too far for the battery, or for the time allowed"
                      : last_resort      ? "no frontier left that can be accepted"
                                         : "no goal of the policy could be accepted";
    }
  }
  if (result.goal || !input.standing) {
    idle_since_.reset();
  } else if (!idle_since_) {
    idle_since_ = input.now;
  }
  if (!policy_failed_)
    for (std::size_t i = 0; i < own_rejections; ++i)
      policy_->notify(
          {PolicyEvent::Kind::goal_rejected, input.now, result.rejected[i].goal, result.rejected[i].reason});

  result.unseen = std::exchange(unseen_, {});
  for (const FrontierOffer& offer : request.frontiers) {
    FrontierCluster brief = *offer.cluster;
    brief.cells.clear();
    result.frontiers.push_back(std::move(brief));
  }
  result.plan_ms = elapsed_ms(begin) - result.decide_ms;
  return result;
}

Path Explorer::plan_to(const Vec3& from, const Vec3& to) {
  const Roadmap& known = roadmap();
  if (to == home_ && is_clear(map_, home_, options_.planning.clearance_m))
    if (const Path way = way_home_.find(map_, known, from); way.found())
      return plan_along(map_, known, way, options_.planning);
  return plan(map_, known, from, to, options_.planning);
}

int Explorer::blocked_segment(const std::vector<Vec3>& points) const {
  return first_blocked_segment(map_, points, options_.planning.clearance_m - kClearanceSlack_m);
}

}  // namespace karst::core
