#include "core_stack/planning/roadmap/roadmap_path.h"

#include <algorithm>

#include "core_stack/planning/free_space/escape.h"

namespace karst::core {
namespace {

void append_cells(const RoadmapGraph& graph, const CellKey& from, const CellKey& to,
                  std::vector<Vec3>& points) {
  if (graph.free.segment_clear(points.back(), graph.free.center_of(to), graph.clearance_m)) {
    points.push_back(graph.free.center_of(to));
    return;
  }
  const std::vector<CellKey> cells = graph.cells_between(from, to);
  for (std::size_t i = 1; i < cells.size(); ++i) points.push_back(graph.free.center_of(cells[i]));
}

}  // namespace

std::vector<Vec3> path_to_clear(const VoxelMap& map, const RoadmapGraph& graph, const Vec3& p) {
  if (graph.free.is_clear(p, graph.clearance_m)) return {p};
  FreeTiles free(map.resolution_m());
  return escape_path(map, free, p, graph.clearance_m).value_or(std::vector<Vec3>{});
}

void append_path(const RoadmapGraph& graph, const Join& out, const std::vector<NodeRef>& nodes,
                 const Join& in, const Vec3& goal, std::vector<Vec3>& points) {
  if (out.via) {
    points.push_back(graph.free.center_of(*out.via));
    append_cells(graph, *out.via, graph.cell_of(nodes.front()), points);
  } else {
    points.push_back(graph.position_of(nodes.front()));
  }
  for (std::size_t i = 1; i < nodes.size(); ++i)
    append_cells(graph, graph.cell_of(nodes[i - 1]), graph.cell_of(nodes[i]), points);
  if (in.via) append_cells(graph, graph.cell_of(nodes.back()), *in.via, points);
  points.push_back(goal);
  points.erase(std::unique(points.begin(), points.end(),
                           [](const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-9; }),
               points.end());
  if (points.size() < 2) points.push_back(goal);
}

}  // namespace karst::core
