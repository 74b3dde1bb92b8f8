// What the vehicle gets to with a given clearance: the roadmap, the ways home, and the viewpoints known
// there.
//
// There is one for the mission's clearance, and where the mission allows narrow passages one for those: it is
// asked only when nothing else is left, or from a place that lies in a narrow passage itself.
#pragma once
#include <map>
#include <optional>
#include <vector>

#include "core_stack/homing/home.h"
#include "core_stack/mission/viewpoints.h"
#include "core_stack/planning/roadmap.h"

namespace karst::core {

struct KnownViewpoint {
  std::uint64_t revision;
  std::vector<CellKey> cells;
  std::optional<Viewpoint> viewpoint;
};

struct Reach {
  explicit Reach(const PlanningOptions& options) : planning(options), roadmap(options) {}

  /// Takes in the changes that are due.
  void update(const VoxelMap& map, const Vec3& home);

  PlanningOptions planning;
  Roadmap roadmap;
  WayHome way_home;
  std::vector<CellChange> due;  // changes it has yet to hear of: it is asked far less often than scanned
  std::map<std::uint32_t, KnownViewpoint> viewpoints;  // by frontier
};

/// The clearance in narrow passages; nothing if the options do not allow for less than the usual.
std::optional<double> narrow_clearance_m(const PlanningOptions& options, double vehicle_radius_m);

/// For narrow passages, on all that the map holds.
Reach narrow_reach(const VoxelMap& map, const PlanningOptions& options, double clearance_m);

}  // namespace karst::core
