// Where to look from: for a frontier cluster, a clear place near it from which the vehicle's sensors see it.
#pragma once
#include <optional>

#include "core_stack/mapping/frontiers/frontiers.h"
#include "core_stack/planning/roadmap/roadmap.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

struct Viewpoint {
  Vec3 position = Vec3::Zero();
  double heading_rad = 0;
};

/// True if some sensor of a level vehicle at the viewpoint has `target` in its field of view and range.
bool in_view(const VehicleDescription& vehicle, const Viewpoint& from, const Vec3& target,
             double lidar_range_m);

/// Cells of the cluster with no rock among their 26 neighbours. Chinks in a wall have none: their unknown is
/// the inside of the rock. An opening that a vehicle fits through has some in its middle.
int open_cells(const VoxelMap& map, const FrontierCluster& cluster);

/// The best of a fixed set of candidates on shells around the cluster: clear, with a free line of sight, the
/// cluster in a sensor's view. If none of them will do, the places of `roadmap` near it, if given: in narrow
/// passages the shells mostly miss the few that are clear. None if there is no such place.
std::optional<Viewpoint> find_viewpoint(const VoxelMap& map, const FrontierCluster& cluster,
                                        const VehicleDescription& vehicle, double clearance_m,
                                        const Roadmap* roadmap = nullptr);

}  // namespace karst::core
