// A sparse graph of clear places that covers all known space, kept up to date from the map's changes: it
// answers "how far, and can I get there" for many goals at once, and finds kilometres of path in
// milliseconds.
//
// One node a block of cells: the clearest free cell of the block, if clear at all. Nodes of neighbouring
// blocks are joined when the straight line between them is clear. Only blocks near a change are revisited.
#pragma once
#include <span>
#include <unordered_map>
#include <vector>

#include "core_stack/mapping/voxel_map.h"
#include "core_stack/planning/path.h"

namespace karst::core {

class Roadmap {
 public:
  explicit Roadmap(const PlanningOptions& options);
  void update(const VoxelMap& map, std::span<const CellChange> changes);

  /// Path lengths in metres from `from` to each goal through the graph (one Dijkstra run); +inf where there
  /// is no way. A goal is joined to nodes it sees along a clear line, or, if itself not clear, to the
  /// nearest clear node within `goal_tolerance_m` and a free line of sight.
  std::vector<double> distances(const VoxelMap& map, const Vec3& from, std::span<const Vec3> goals,
                                double goal_tolerance_m) const;
  Path find(const VoxelMap& map, const Vec3& from, const Vec3& goal) const;
  std::size_t node_count() const;

 private:
  // the implementer's
};

}  // namespace karst::core
