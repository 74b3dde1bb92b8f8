#include "core_stack/mission/decision/goal_selection.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core_stack/homing/path_home/home.h"
#include "core_stack/mapping/region/flight_region.h"
#include "core_stack/planning/search/grid_planner.h"

namespace karst::core {
namespace {

/// Number of plans that a cycle tries for one list; the other goals wait for the next cycle.
constexpr int kMaxPlans = 5;

/// A path flown at nearly zero speed would hold the vehicle until the battery forces it home.
std::optional<std::string> too_slow(const Goal& goal, const MotionLimits& limits) {
  const double min_mps = std::min(limits.min_speed_mps, limits.max_speed_mps);
  if (goal.max_speed_mps == 0 || goal.max_speed_mps >= min_mps) return std::nullopt;
  char text[96];
  std::snprintf(text, sizeof text, "its speed limit of %.2g m/s is below motion.min_speed, %g m/s",
                goal.max_speed_mps, min_mps);
  return text;
}

}  // namespace

GoalSelection::GoalSelection(const CoreOptions& options, const VehicleDescription& vehicle,
                             const WorldModel& world, HomeEstimator& home, GoalLedger& ledger)
    : motion_(options.motion),
      view_(steepest_view(vehicle)),
      world_(&world),
      home_(&home),
      ledger_(&ledger) {}

GoalChoice GoalSelection::choose(const GoalQuery& query, const std::vector<Goal>& goals) {
  const CycleInput& input = *query.input;
  GoalChoice choice;
  int plans = 0, closed = 0;
  std::size_t too_far = 0;
  for (const Goal& goal : goals) {
    if (plans == kMaxPlans) {
      choice.more_to_try = closed > 0;
      break;
    }
    if (const auto problem = objection(query, goal)) {
      choice.rejected.push_back({goal, *problem});
      continue;
    }
    ++plans;
    const Path path = world_->plan(*query.roadmap, input.from, goal.position);
    if (!path.found()) {
      const std::string failure = "no path: " + path.reason;
      ledger_->close(world_->map(), goal.position, input.now, failure);
      ++closed;
      choice.rejected.push_back({goal, failure});
    } else if (const auto blind = blind_climb(view_, input.flown_path, path.points)) {
      ledger_->pause(world_->map(), goal.position, input.now,
                     *blind);  // from elsewhere, the way there is less steep
      ++closed;
      choice.rejected.push_back({goal, *blind});
    } else if (affordable(input, goal, path)) {
      choice.goal = goal;
      choice.path = path;
      break;
    } else {
      ++too_far;
      choice.rejected.push_back({goal, input.limited_by_time()
                                           ? "the time allowed does not suffice for going there and home"
                                           : "the battery does not last for going there and home"});
    }
  }
  choice.all_too_far = too_far > 0 && too_far == choice.rejected.size();
  return choice;
}

std::optional<std::string> GoalSelection::objection(const GoalQuery& query, const Goal& goal) const {
  const VoxelMap& map = world_->map();
  const Vec3& p = goal.position;
  if (!p.allFinite()) return "its position is not finite";
  if (std::isinf(goal.heading_rad)) return "its heading is not finite";
  if (const auto why = too_slow(goal, motion_)) return why;
  if (map.region() && !map.region()->may_fly(p)) return "it lies outside " + map.region()->nearest_part(p);
  if (map.at(p) != Cell::free)
    return map.at(p) == Cell::occupied ? "it lies in an occupied cell" : "it lies in unknown space";
  if (!is_clear(map, p, query.roadmap->clearance_m()))
    return map.region() && map.region()->depth_m(p) - map.region()->limits().margin_m <
                               query.roadmap->clearance_m() + map.resolution_m()
               ? "it is too near to the border of " + map.region()->nearest_part(p) +
                     ", rock or unknown space"
               : "it is too near to rock or unknown space";
  if (const auto why = ledger_->closed(map, p, query.rules)) return "it was tried before: " + *why;
  return std::nullopt;
}

bool GoalSelection::affordable(const CycleInput& input, const Goal& goal, const Path& path) const {
  const HomeEstimate home = home_->estimate(goal.position, input.flown_length_m + path.length_m);
  const double there_s = flight_time_s(path.length_m, motion_);
  return home_->slack_s(input.seconds_left - there_s, home) > 0;
}

}  // namespace karst::core
