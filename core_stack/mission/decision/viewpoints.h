// Viewpoints: for a frontier cluster, a clear place near it from which the vehicle's sensors see it.
#pragma once
#include <optional>

#include "core_stack/mapping/frontiers/frontiers.h"
#include "core_stack/mission/world_model/clearance_roadmap.h"
#include "core_stack/planning/roadmap/roadmap.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

struct Viewpoint {
  Vec3 position = Vec3::Zero();
  double heading_rad = 0;
};

/// Whether a sensor of a level vehicle at the viewpoint has `target` in its field of view and range.
bool in_view(const VehicleDescription& vehicle, const Viewpoint& from, const Vec3& target,
             double lidar_range_m);

/// Counts cells of the cluster without occupied cells among their 26 neighbours. Gaps in a wall have none:
/// the unknown behind them is the inside of the rock. An opening that a vehicle fits through has some.
int open_cells(const VoxelMap& map, const FrontierCluster& cluster);

/// Whether a body of radius `radius_m` at one of the cluster's cells would touch no rock, by what is known.
/// Then space that the vehicle fits into may begin there; otherwise it is a crack.
bool fits_through(const VoxelMap& map, const FrontierCluster& cluster, double radius_m);

/// The best of a fixed set of candidates on shells around the cluster that are clear, have a free line of
/// sight, and have the cluster in a sensor's view. If there are none, the nodes of `roadmap` nearby are
/// tried, if given: in narrow passages the shells mostly miss the few clear places. Nothing if no viewpoint
/// is found.
std::optional<Viewpoint> find_viewpoint(const VoxelMap& map, const FrontierCluster& cluster,
                                        const VehicleDescription& vehicle, double clearance_m,
                                        const Roadmap* roadmap = nullptr);

/// The place of `reachable.roadmap()` nearest to the cluster that has a way home, a free line of sight and
/// the cluster in a sensor's view, at most 10 m away. Nothing if there is none.
std::optional<Viewpoint> find_distant_viewpoint(const VoxelMap& map, const FrontierCluster& cluster,
                                                const VehicleDescription& vehicle,
                                                const ClearanceRoadmap& reachable);

}  // namespace karst::core
