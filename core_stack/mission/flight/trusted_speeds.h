// How fast a vehicle may fly along a path by what its sensors see of the way, and by the room beside it.
#pragma once
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/mission/options/mission_options.h"
#include "core_stack/planning/trajectory/speed_by_trust.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// Up to this speed, a vehicle flies wherever its clearance allows, whatever its sensors see of the way:
/// every trajectory ends at rest in known free space.
constexpr double kTrusted_mps = 2.0;

/// What the sensors tell in time of rock that was not there before.
struct SensedAhead {
  struct Band {
    double range_m = 0, low_rad = 0, high_rad = 0;  // elevations, of a level vehicle that flies ahead
  };
  std::vector<Band> bands;
  double reaction_s = 0;   // from when rock appears until the vehicle brakes, at most
  double range_m() const;  // straight ahead
};
SensedAhead sensed_ahead(const CoreOptions& options, const VehicleDescription& vehicle);

/// Whether the rule applies: not to missions that allow no more than kTrusted_mps.
bool by_trust(const MotionLimits& motion);

/// In narrow places, and where the safety supervisor asks for it.
double slow_speed_mps(const CoreOptions& options);

/// The options as this vehicle flies: with no more than the speed that its sensors allow in open space, which
/// is also what its way home is planned with. Where speeds are by trust, trajectories are sampled.
CoreOptions as_flown(CoreOptions options, const VehicleDescription& vehicle);

/// The greatest speed of all, where the sensors see the way as far as they reach.
double open_space_speed_mps(const CoreOptions& options, const SensedAhead& sensed, double braking_mps2);

/// Limits along `points`. They are kTrusted_mps or more.
TrustedSpeeds trusted_speeds(const VoxelMap& map, const CoreOptions& options,
                             const VehicleDescription& vehicle, const std::vector<Vec3>& points,
                             double braking_mps2);

}  // namespace karst::core
