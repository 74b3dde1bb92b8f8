#include "core_stack/planning/search/ompl_search.h"

#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <bit>
#include <mutex>

#include "core_stack/planning/free_space/escape.h"
#include "core_stack/planning/roadmap/roadmap_graph.h"
#include "core_stack/planning/search/grid_planner.h"
#include "core_stack/planning/search/ompl_grid_planner.h"
#include "core_stack/planning/search/ompl_problem.h"

namespace karst::core {

namespace ob = ompl::base;
namespace og = ompl::geometric;

OmplGridPlanner::OmplGridPlanner(const ob::SpaceInformationPtr& si, const VoxelMap& map,
                                 const PlanningOptions& options)
    : ob::Planner(si, "grid"), map_(map), options_(options) {
  specs_.recognizedGoal = ob::GOAL_STATE;
  specs_.provingSolutionNonExistence = true;
}

ob::PlannerStatus OmplGridPlanner::solve(const ob::PlannerTerminationCondition& stop) {
  checkValidity();
  const ob::State* from = pis_.nextStart();
  if (from == nullptr) return ob::PlannerStatus::INVALID_START;
  const ob::State* to = pis_.nextGoal();
  if (to == nullptr) return ob::PlannerStatus::INVALID_GOAL;
  pis_.restart();
  if (stop) return ob::PlannerStatus::TIMEOUT;
  const Path path = plan_on_grid(map_, point_of(from), point_of(to), options_);
  if (path.status == PlanStatus::gave_up) return ob::PlannerStatus::TIMEOUT;
  if (!path.found()) return ob::PlannerStatus::ABORT;
  const auto states = std::make_shared<og::PathGeometric>(si_);
  ob::State* s = si_->allocState();
  for (const Vec3& p : path.points) {
    set_point(s, p);
    states->append(s);
  }
  si_->freeState(s);
  pdef_->addSolutionPath(states, false, 0.0, getName());
  return ob::PlannerStatus::EXACT_SOLUTION;
}

namespace {

constexpr double kAround_m = 10.0;
/// Maximal edge length of the trees: about the range of sight in a cave.
constexpr double kRange_m = 5.0;
/// An iteration of BIT* processes one edge and takes about a tenth of the time of one of RRT*.
constexpr std::int64_t kEdgesPerIteration = 10;

/// OMPL has one seed generator and one log handler per process.
std::mutex& ompl_lock() {
  static std::mutex lock;
  return lock;
}

std::uint_fast32_t seed_of(const Vec3& start, const Vec3& goal) {
  std::uint64_t h = 0xcbf29ce484222325ull;  // FNV-1a
  for (const double v : {start.x(), start.y(), start.z(), goal.x(), goal.y(), goal.z()})
    for (std::uint64_t bits = std::bit_cast<std::uint64_t>(v), i = 0; i < 8; ++i, bits >>= 8)
      h = (h ^ (bits & 255)) * 0x100000001b3ull;
  return static_cast<std::uint_fast32_t>((h >> 33) + 1);
}

ob::PlannerPtr make_planner(const ob::SpaceInformationPtr& si, const VoxelMap& map,
                            const PlanningOptions& options) {
  if (options.planner == Planner::rrt_connect) {
    const auto planner = std::make_shared<og::RRTConnect>(si);
    planner->setRange(kRange_m);
    return planner;
  }
  if (options.planner == Planner::rrt_star) {
    const auto planner = std::make_shared<og::RRTstar>(si);
    planner->setRange(kRange_m);
    return planner;
  }
  if (options.planner == Planner::bit_star) {
    const auto planner = std::make_shared<og::BITstar>(si);
    planner->setSamplesPerBatch(400);
    return planner;
  }
  return std::make_shared<OmplGridPlanner>(si, map, options);
}

/// The roadmap's cells whose nodes lie between `low` and `high`.
std::shared_ptr<SampledCells> cells_between(const RoadmapGraph& graph, const Vec3& low, const Vec3& high) {
  auto out = std::make_shared<SampledCells>();
  std::uint64_t count = 0;
  for (const RoadmapTile& tile : graph.tiles)
    for (const RoadmapNode& node : tile.nodes) {
      const Vec3 p = graph.free.center_of(node.place);
      if ((p.array() < low.array()).any() || (p.array() > high.array()).any()) continue;
      out->blocks.push_back({{node.place.x & ~3, node.place.y & ~3, node.place.z & ~3}, node.cells});
      out->up_to.push_back(count += static_cast<std::uint64_t>(std::popcount(node.cells)));
    }
  return out;
}

/// Corner points of the planner's path; empty if it found none.
std::vector<Vec3> solved(const OmplProblem& problem, const ob::PlannerPtr& planner, std::int64_t iterations) {
  planner->setProblemDefinition(problem.definition);
  planner->setup();
  std::int64_t count = 0;
  const ob::PlannerTerminationCondition stop([&count, iterations] { return ++count > iterations; });
  planner->solve(stop);
  if (!problem.definition->hasExactSolution()) return {};
  auto* path = problem.definition->getSolutionPath()->as<og::PathGeometric>();
  std::vector<Vec3> out;
  for (const ob::State* s : path->getStates()) out.push_back(point_of(s));
  return out;
}

}  // namespace

Path search_with_ompl(const VoxelMap& map, const Roadmap& roadmap, const Vec3& start, const Vec3& goal,
                      const PlanningOptions& options, double clearance_m) {
  const Path coarse = roadmap.find(map, start, goal);
  if (!coarse.found()) return coarse;
  const RoadmapGraph& graph = roadmap.graph();
  Path path;
  const auto fail = [&path](PlanStatus status, std::string reason) {
    path = Path{};
    path.status = status;
    path.reason = std::move(reason);
    return path;
  };
  if (!graph.free.is_clear(goal, clearance_m))
    return fail(PlanStatus::goal_blocked, "the goal is nearer to an obstacle than the clearance");
  path.points = {start};
  if (!graph.free.is_clear(start, clearance_m)) {
    FreeTiles near_start(map.resolution_m());
    path.points = escape_path(map, near_start, start, clearance_m).value_or(std::vector<Vec3>{});
    if (path.points.empty())
      return fail(PlanStatus::start_blocked,
                  "the start is nearer to an obstacle than the clearance and no way leads out");
  }
  path.escape_points = path.points.size() - 1;
  const Vec3 from = path.points.back();

  Vec3 low = from.cwiseMin(goal), high = from.cwiseMax(goal);
  for (const Vec3& p : coarse.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  low.array() -= kAround_m;
  high.array() += kAround_m;
  PlanningOptions at_clearance = options;
  at_clearance.clearance_m = clearance_m;
  std::vector<Vec3> found;
  {
    const std::lock_guard<std::mutex> alone(ompl_lock());
    ompl::msg::noOutputHandler();  // stdout belongs to the user; the result contains what matters
    ompl::RNG::setSeed(seed_of(from, goal));
    const OmplProblem problem =
        make_problem(graph.free, cells_between(graph, low, high), {low, high, from, goal, clearance_m});
    const std::int64_t steps =
        options.planner_iterations * (options.planner == Planner::bit_star ? kEdgesPerIteration : 1);
    found = solved(problem, make_planner(problem.space, map, at_clearance), steps);
  }
  if (found.size() < 2)
    return fail(PlanStatus::gave_up, std::string(name_of(options.planner)) + " found no way in " +
                                         std::to_string(options.planner_iterations) + " iterations");
  found.back() = goal;  // planners reach it only up to rounding
  path.points.insert(path.points.end(), found.begin() + 1, found.end());
  path.status = PlanStatus::found;
  measure(path, std::numeric_limits<double>::infinity());
  return path;
}

}  // namespace karst::core
