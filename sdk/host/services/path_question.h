// A query of the path service, answered from a request's map and roadmap: the same in the host's process and
// for a policy in a separate process.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::host {

/// Limit for one query: blocks, nodes and cells searched for a clear position near goals that are not clear.
/// About half a second.
constexpr std::uint64_t kMaxPathWork = 20'000'000;

struct PathAnswer {
  enum class Status : std::uint32_t { answered, no_roadmap, too_much } status = Status::no_roadmap;
  std::vector<double> lengths_m;  // one for each goal, if answered
};

/// Lengths of paths through the request's map.
using PathLengths =
    std::function<PathAnswer(const core::Vec3& from, std::span<const core::Vec3> goals, double tolerance_m)>;

/// As core::Roadmap::distances gives them, or `too_much` if goals and tolerance would cost more than
/// kMaxPathWork: counted, so that it is the same in every run.
inline PathAnswer path_lengths(const core::VoxelMap& map, const core::Roadmap& roadmap,
                               const core::Vec3& from, std::span<const core::Vec3> goals,
                               double tolerance_m) {
  core::WorkBudget work(kMaxPathWork);
  constexpr double any_m = std::numeric_limits<double>::infinity();
  std::vector<double> lengths_m = roadmap.distances(map, from, goals, tolerance_m, any_m, &work);
  if (work.exhausted()) return {PathAnswer::Status::too_much, {}};
  return {PathAnswer::Status::answered, std::move(lengths_m)};
}

/// A path to one goal. Without a known path there are no points.
struct FoundPath {
  std::vector<core::Vec3> points;
  double length_m = std::numeric_limits<double>::infinity();
  double clearance_m = 0;
};

struct PathsAnswer {
  PathAnswer::Status status = PathAnswer::Status::no_roadmap;
  std::vector<FoundPath> paths;  // one for each goal, if answered
};

/// Paths through the request's map.
using PathSearch =
    std::function<PathsAnswer(const core::Vec3& from, std::span<const core::Vec3> goals, double tolerance_m)>;

/// As core::Roadmap::find gives them, with the ends of core::Roadmap::distances; or `too_much` beyond
/// kMaxPathWork, KARST_MAX_PATHS or KARST_MAX_PATH_POINTS. The same in a replay.
PathsAnswer find_paths(const core::VoxelMap& map, const core::Roadmap& roadmap, const core::Vec3& from,
                       std::span<const core::Vec3> goals, double tolerance_m);

}  // namespace karst::host
