// No climb and no descent where the vehicle does not look: shafts need a sensor that faces up or down.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// Length of way that is looked at together: sweeping to and fro in a shaft does not make it a ramp.
constexpr double kClimbWindow_m = 40.0;

/// Steepest directions, up and down, that some sensor of a level vehicle sees; both in 0 to pi/2.
struct SteepestView {
  double up_rad = 0, down_rad = 0;
};
SteepestView steepest_view(const VehicleDescription& vehicle);

/// Why `path`, flown after `flown_path` (all of it), is steeper than the vehicle sees; nothing if it is not.
/// It is where within kClimbWindow_m of way it climbs or sinks by h, more than 3 m, and all of that stretch
/// lies within less than h / tan(steepest view) horizontally; unless the vehicle was as high (as low) within
/// 4 m of there already, or half a metre less if that was more than kClimbWindow_m of way ago: the way back
/// is free.
std::optional<std::string> blind_climb(const SteepestView& view, const std::vector<Vec3>& flown_path,
                                       const std::vector<Vec3>& path);

}  // namespace karst::core
