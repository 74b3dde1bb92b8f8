// From nodes of the roadmap to points in space. Private to planning.
#pragma once
#include <vector>

#include "core_stack/planning/roadmap/roadmap_graph.h"

namespace karst::core {

/// From `p` to a clear point: p itself, or the way out of a tight place. Empty if there is none.
std::vector<Vec3> path_to_clear(const VoxelMap& map, const RoadmapGraph& graph, const Vec3& p);

/// Appends to `points`, which end where `out` was asked for, the way through the nodes (at least one, each
/// joined to the next) and by `in` to `goal`: straight where that is clear, else cell by cell.
void append_path(const RoadmapGraph& graph, const Join& out, const std::vector<NodeRef>& nodes,
                 const Join& in, const Vec3& goal, std::vector<Vec3>& points);

}  // namespace karst::core
