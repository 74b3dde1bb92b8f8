// The ground truth of coverage: the space of a cave that a vehicle can fly through, and the space visible
// from there. For evaluation only; not available to anything that flies.
#pragma once
#include "plugins/simulator/cave/triangle_mesh.h"
#include "sdk/evaluation/reachable/cell_set.h"

namespace karst::evaluation {

struct ReachableOptions {
  double resolution_m = 0.2;  // of the map: cell k covers [k, k+1) * resolution, as in core::VoxelMap
  // Least distance from a flyable cell's centre to rock. The same for all missions, so that their coverage is
  // comparable: twice the default vehicle's radius.
  double clearance_m = 0.6;
  double sight_m = 20;  // greatest distance at which free space is seen from a flyable cell
};

/// Exact on the grid:
/// - rock: cells, as closed cubes, that share a point with a triangle;
/// - free: cells that are not rock and 6-connected to the start;
/// - flyable: free cells with a centre at least `clearance_m` from every triangle, 6-connected to the start;
/// - reachable: flyable cells, and free cells from whose centre a ray in one of a fixed set of directions
///   (to the 26 neighbours, and 256 spread evenly over the sphere) runs through free cells only into a
///   flyable one, within `sight_m`.
struct Reachable {
  ReachableOptions options;
  CellSet free, flyable, reachable;  // flyable is part of reachable, and reachable of free
  std::size_t free_cells = 0, flyable_cells = 0, reachable_cells = 0;

  bool contains(const CellKey& k) const { return reachable.contains(k); }
  double cell_m3() const { return options.resolution_m * options.resolution_m * options.resolution_m; }
  double free_volume_m3() const { return static_cast<double>(free_cells) * cell_m3(); }
  double flyable_volume_m3() const { return static_cast<double>(flyable_cells) * cell_m3(); }
  /// The denominator of coverage.
  double volume_m3() const { return static_cast<double>(reachable_cells) * cell_m3(); }
};

/// `name`: the mesh's name, for messages. A start nearer to rock than the clearance, such as that of a
/// vehicle on the ground, is replaced by the nearest flyable cell within 3 m along a straight free line.
/// Throws InputError if the start is in rock, if nothing flyable is near it, if free space leads outside the
/// mesh (with the position), or if the mesh is too large for the resolution.
Reachable find_reachable(const cave::TriangleMesh& mesh, const core::Vec3& start,
                         const ReachableOptions& options, const std::string& name);

/// Throws the same errors for a start and mesh, in a fraction of the time.
void check_reachable(const cave::TriangleMesh& mesh, const core::Vec3& start, const ReachableOptions& options,
                     const std::string& name);

}  // namespace karst::evaluation
