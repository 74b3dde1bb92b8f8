// Shortest paths over the roadmap from all places to one root, updated incrementally as the roadmap changes.
// A query takes microseconds, however far the root is.
//
// Every node stores the length of its shortest path to the root. When nodes vanish, nodes whose path led
// through them are invalidated. These and new nodes then relax from their neighbours, and improvements
// propagate, shortest first (after Ramalingam and Reps, 1996). The cost of an update is proportional to the
// number of nodes whose distance changes: few at the edge of the explored space, all that lie behind a
// rockfall. The lengths are bitwise equal to those computed from scratch.
#pragma once
#include <memory>
#include <optional>

#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::core {

class DistanceTree {
 public:
  DistanceTree();
  ~DistanceTree();
  DistanceTree(DistanceTree&&) noexcept;
  DistanceTree& operator=(DistanceTree&&) noexcept;

  /// Call after each update of the roadmap, which must always be the same one, and before queries. If the
  /// root lacks the search clearance there are no distances. If the root moves, all are computed from
  /// scratch.
  void update(const Roadmap& roadmap, const Vec3& root);

  /// Length in metres of the shortest path from `from` to the root on the roadmap, including an escape from a
  /// tight place; nothing if there is none.
  std::optional<double> length_m(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from) const;
  /// About the same from a clear cell, many times faster: the lines to the nearest nodes are not checked, so
  /// it may be too short by a fraction of a block. Nothing from any other cell.
  std::optional<double> estimated_length_m(const Roadmap& roadmap, const Vec3& from) const;
  /// The path of length_m, with the search clearance. It is raw: pass it to refine_path. It depends on the
  /// current map only, not on the map's history.
  Path find(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from) const;

  /// Number of nodes whose distance the last update visited: its cost.
  std::size_t touched() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace karst::core
