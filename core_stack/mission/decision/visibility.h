// Forbids climbs and descents that the sensors do not cover: shafts need a sensor that faces up or down.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// The window of path length that is checked together: sweeping to and fro in a shaft does not make it a
/// ramp.
constexpr double kClimbWindow_m = 40.0;

/// The steepest directions, up and down, that a sensor of a level vehicle sees; both in 0 to pi/2.
struct SteepestView {
  double up_rad = 0, down_rad = 0;
};
SteepestView steepest_view(const VehicleDescription& vehicle);

/// Why `path`, flown after the whole of `flown_path`, is steeper than the vehicle sees; nothing if it is not.
/// A path is too steep if within kClimbWindow_m of its length it climbs or sinks by h > 3 m, and that stretch
/// extends horizontally by less than h / tan(steepest view). Exempt are heights that the vehicle has reached
/// before within 4 m of there (give or take half a metre if that was more than kClimbWindow_m of path ago),
/// so that the path back is always allowed.
std::optional<std::string> blind_climb(const SteepestView& view, const std::vector<Vec3>& flown_path,
                                       const std::vector<Vec3>& path);

}  // namespace karst::core
