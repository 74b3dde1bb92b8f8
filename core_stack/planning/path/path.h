// A path, and the result of planning it.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/options.h"

namespace karst::core {

/// What searches for paths: the grid search and the roadmap, or one of OMPL's planners.
enum class Planner { grid, rrt_connect, rrt_star, bit_star };
constexpr auto names_of(Planner) {
  using enum Planner;
  return std::to_array<Named<Planner>>(
      {{grid, "grid"}, {rrt_connect, "rrt_connect"}, {rrt_star, "rrt_star"}, {bit_star, "bit_star"}});
}

struct PlanningOptions {
  double clearance_m = 0.6;            // least distance of the path from the centre of any occupied or
                                       // unknown-boundary cell; must exceed the vehicle's radius
  double preferred_clearance_m = 1.0;  // refining moves the path to this clearance where there is room
  double narrow_margin_m = 0;          // beyond the vehicle's radius, in narrow passages; 0: not flown
  double search_slack_cells = 0.25;    // not an option: how much less clearance the searches use
  double heuristic_weight = 1.2;       // bounded sub-optimality of the grid search; 1: optimal
  std::int64_t max_expansions = 400000;
  Planner planner = Planner::grid;
  std::int64_t planner_iterations = 5000;
};
void describe(OptionTable& t, PlanningOptions& o);

/// The clearance used by the searches on cells' centres; refining makes up for the difference. Centres sample
/// space at the resolution only, and the middle of a narrow passage may lie between two of them.
inline double search_clearance_m(const PlanningOptions& o, double resolution_m) {
  return o.clearance_m - o.search_slack_cells * resolution_m;
}
/// The minimal clearance of a flown path, where refining cannot make up for all of the difference.
inline double min_clearance_m(const PlanningOptions& o, double resolution_m) {
  return o.clearance_m - 0.25 * resolution_m;
}

enum class PlanStatus { found, start_blocked, goal_blocked, no_path, gave_up };

struct Path {
  PlanStatus status = PlanStatus::no_path;
  std::string reason;             // when not found: a sentence a user can act on
  std::vector<Vec3> points;       // world frame, first is the start, last the goal
  std::size_t escape_points = 0;  // number of leading points within the clearance of an obstacle: the escape
                                  // from a tight place
  double length_m = 0;
  /// length_m is at most this factor times the shortest path on the grid: the grid search's bound
  /// (heuristic_weight, times the change by refining), or the ratio of length_m to the straight distance if
  /// that is less. For paths of the roadmap and of OMPL, only the latter holds.
  double length_bound = std::numeric_limits<double>::infinity();
  double clear_by_m = 0;            // clearance of all segments after the escape; 0: not checked
  std::vector<Vec3> narrow_places;  // about 0.5 m apart; of less clearance, flown slowly
  bool narrow() const { return !narrow_places.empty(); }
  bool found() const { return status == PlanStatus::found; }
};

double path_length_m(const std::vector<Vec3>& points);

/// Within this radius of a narrow place flight is slow, and less clearance suffices.
constexpr double kNarrowRadius_m = 1.0;
bool near_narrow_place(const std::vector<Vec3>& places, const Vec3& a, const Vec3& b);

/// Sets length_m, and length_bound from the planner's bound and the straight distance.
void measure(Path& path, double promised_bound);

}  // namespace karst::core
