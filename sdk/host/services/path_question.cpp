#include "sdk/host/services/path_question.h"

#include <optional>
#include <utility>

#include "sdk/abi/karst_abi_services.h"

namespace karst::host {
namespace {

/// A straight line is taken up to this length: the zigzag of the graph would matter there.
constexpr double kDirect_m = 5.0;

/// Steps of work for each node of the roadmap in one search, which may visit all of them.
constexpr std::uint64_t kStepsPerNode = 4;

/// Steps of work for each look at the clearance of a path, four of them for each cell of its length at most.
constexpr double kStepsPerLook = 20;

PathsAnswer too_much() { return {PathAnswer::Status::too_much, {}}; }

std::vector<core::Vec3> points_between(const core::VoxelMap& map, const core::Roadmap& roadmap,
                                       const core::Vec3& from, const core::Vec3& end) {
  const double clearance_m = core::search_clearance_m(roadmap.options(), map.resolution_m());
  if ((end - from).norm() <= kDirect_m && roadmap.segment_clear(from, end, clearance_m)) return {from, end};
  core::Path path = roadmap.find(map, from, end, core::EqualPaths::by_place);
  return path.found() ? std::move(path.points) : std::vector<core::Vec3>{};
}

}  // namespace

PathsAnswer find_paths(const core::VoxelMap& map, const core::Roadmap& roadmap, const core::Vec3& from,
                       std::span<const core::Vec3> goals, double tolerance_m) {
  if (goals.size() > KARST_MAX_PATHS) return too_much();
  core::WorkBudget work(kMaxPathWork);
  const std::uint64_t search_steps = kStepsPerNode * roadmap.node_count();
  std::size_t points = 0;
  PathsAnswer answer{PathAnswer::Status::answered, {}};
  for (const core::Vec3& goal : goals) {
    FoundPath& found = answer.paths.emplace_back();
    const std::optional<core::Vec3> end = roadmap.approach(map, goal, tolerance_m, &work);
    if (work.exhausted() || !work.spend(search_steps)) return too_much();
    if (!end) continue;
    found.points = points_between(map, roadmap, from, *end);
    if (found.points.empty()) continue;
    points += found.points.size();
    if (points > KARST_MAX_PATH_POINTS) return too_much();
    found.length_m = core::path_length_m(found.points);
    const double looks = 4 * found.length_m / map.resolution_m() + static_cast<double>(found.points.size());
    if (!work.spend(static_cast<std::uint64_t>(kStepsPerLook * looks))) return too_much();
    found.clearance_m = roadmap.least_clearance_m(found.points);
  }
  return answer;
}

}  // namespace karst::host
