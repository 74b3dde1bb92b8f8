// Converts nodes of the roadmap to a path of points. Private to planning.
#pragma once
#include <vector>

#include "core_stack/planning/roadmap/roadmap_graph.h"

namespace karst::core {

/// The path from `p` to a clear point: p itself, or the escape from a tight place. Empty if there is none.
std::vector<Vec3> path_to_clear(const VoxelMap& map, const RoadmapGraph& graph, const Vec3& p);

/// Appends to `points`, which end where `out` begins, the path through the nodes (at least one, each joined
/// to the next) and by `in` to `goal`: straight lines where they are clear, else cell by cell.
void append_path(const RoadmapGraph& graph, const Join& out, const std::vector<NodeRef>& nodes,
                 const Join& in, const Vec3& goal, std::vector<Vec3>& points);

}  // namespace karst::core
