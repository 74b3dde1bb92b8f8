// A sparse graph of clear places that covers all known space, kept up to date from the map's changes: it
// answers "how far, and can I get there" for many goals at once, and finds kilometres of path in
// milliseconds.
//
// Space is cut into blocks of 4 x 4 x 4 cells. A node is a 26-connected component of clear cells inside a
// block, placed at its cell nearest the block's middle. Two nodes of neighbouring blocks are joined when a
// cell of one touches a cell of the other. So the graph connects exactly what the grid search connects,
// narrow passages included; it is wholly determined by the clear cells, and an update looks only at tiles
// near a change.
#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/path/path.h"
#include "core_stack/planning/roadmap/work_budget.h"

namespace karst::core {

struct RoadmapGraph;  // private to planning

class Roadmap {
 public:
  explicit Roadmap(const PlanningOptions& options);
  ~Roadmap();
  Roadmap(Roadmap&&) noexcept;
  Roadmap& operator=(Roadmap&&) noexcept;

  /// `changes` must hold every cell whose class changed since the last update; the first update may hold
  /// every known cell of a map read from a file. Throws InputError if the clearance is more than 15 cells.
  void update(const VoxelMap& map, std::span<const CellChange> changes);

  /// Path lengths in metres from `from` to each goal through the graph (one Dijkstra run); +inf where there
  /// is no way. The graph's ways zigzag a little: some per cent longer than the path flown. A goal is joined
  /// to nodes it sees along a clear line, or, if itself not clear, to `approach(goal)`. Ways through the
  /// graph longer than `max_m` are not looked for: +inf as well. Looking for places to approach counts
  /// against `work`, a step for each block, node and cell looked at; once it is exhausted the lengths mean
  /// nothing.
  std::vector<double> distances(const VoxelMap& map, const Vec3& from, std::span<const Vec3> goals,
                                double goal_tolerance_m,
                                double max_m = std::numeric_limits<double>::infinity(),
                                WorkBudget* work = nullptr) const;
  /// A path of the search's clearance (search_clearance_m); raw: pass it to refine_path.
  Path find(const VoxelMap& map, const Vec3& from, const Vec3& goal) const;
  /// `goal` if it is clear, else the nearest node within `tolerance_m` that sees it through free cells.
  std::optional<Vec3> approach(const VoxelMap& map, const Vec3& goal, double tolerance_m,
                               WorkBudget* work = nullptr) const;

  /// The graph's nodes within `reach_m` of p: clear by the search's clearance, and less than a cell from a
  /// point that is so by the whole.
  std::vector<Vec3> places_near(const Vec3& p, double radius_m) const;

  /// The straight line runs through free cells and is nowhere nearer than `clearance_m` to an obstacle's
  /// centre, as the map was at the last update. Microseconds.
  bool segment_clear(const Vec3& a, const Vec3& b, double clearance_m) const;

  std::size_t node_count() const;
  const PlanningOptions& options() const;
  const RoadmapGraph& graph() const { return *graph_; }

 private:
  std::unique_ptr<RoadmapGraph> graph_;
};

}  // namespace karst::core
