// A sparse graph of clear places that covers all known space, updated from the map's changes. It answers
// reachability and distance queries for many goals at once, and finds paths of kilometres in milliseconds.
//
// Space is divided into blocks of 4 x 4 x 4 cells. A node is a 26-connected component of clear cells in a
// block, positioned at its cell nearest to the block's centre. Two nodes of neighbouring blocks are joined if
// a cell of one touches a cell of the other. The graph therefore has the connectivity of the grid search,
// narrow passages included. It is determined by the clear cells alone, and an update visits only tiles near a
// change.
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

/// Which of several equally short paths a search finds. `as_stored` depends on the order in which space was
/// seen; `by_place` depends on the map alone, and is the same on a roadmap rebuilt from a record.
enum class EqualPaths { as_stored, by_place };

class Roadmap {
 public:
  explicit Roadmap(const PlanningOptions& options);
  ~Roadmap();
  Roadmap(Roadmap&&) noexcept;
  Roadmap& operator=(Roadmap&&) noexcept;

  /// `changes` must contain every cell whose class has changed since the last update; at the first update,
  /// all known cells of a map read from a file. Throws InputError if the clearance exceeds 15 cells.
  void update(const VoxelMap& map, std::span<const CellChange> changes);

  /// Path lengths in metres from `from` to each goal through the graph (one Dijkstra run); +inf if there is
  /// no path or it is longer than `max_m`. Paths in the graph zigzag and are a few per cent longer than the
  /// path flown. A goal is joined to nodes along clear lines of sight, or, if it is not clear, to
  /// `approach(goal)`. The search for approach points spends `work`, a step for each block, node and cell
  /// visited; once it is exhausted, the lengths are invalid.
  std::vector<double> distances(const VoxelMap& map, const Vec3& from, std::span<const Vec3> goals,
                                double goal_tolerance_m,
                                double max_m = std::numeric_limits<double>::infinity(),
                                WorkBudget* work = nullptr) const;
  /// A path with the search clearance (search_clearance_m). It is raw: pass it to refine_path.
  Path find(const VoxelMap& map, const Vec3& from, const Vec3& goal,
            EqualPaths equal = EqualPaths::as_stored) const;
  /// `goal` if it is clear, else the nearest node within `tolerance_m` with line of sight to it.
  std::optional<Vec3> approach(const VoxelMap& map, const Vec3& goal, double tolerance_m,
                               WorkBudget* work = nullptr) const;

  /// The graph's nodes within `radius_m` of p. Each has the search clearance, and lies within a cell of a
  /// point with the whole clearance.
  std::vector<Vec3> places_near(const Vec3& p, double radius_m) const;

  /// Whether the straight line runs through free cells and nowhere nearer than `clearance_m` to an obstacle's
  /// centre, as of the last update. Takes microseconds.
  bool segment_clear(const Vec3& a, const Vec3& b, double clearance_m) const;
  /// Distance from p to the nearest centre of a cell that is not free, as of the last update: at most 15
  /// cells, and 0 before the first update.
  double clearance_m(const Vec3& p) const;
  /// Least distance from the polyline to the centre of any cell that is not free, as of the last update: to
  /// an eighth of a cell, and at most 15 cells. 0 without points, or before the first update.
  double least_clearance_m(std::span<const Vec3> points) const;

  std::size_t node_count() const;
  const PlanningOptions& options() const;
  const RoadmapGraph& graph() const { return *graph_; }

 private:
  std::unique_ptr<RoadmapGraph> graph_;
};

}  // namespace karst::core
