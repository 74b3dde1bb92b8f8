// What the sensors of a vehicle see of a cave that is known, from one place.
//
// Every cell in the field of view, within range and in line of sight of its centre counts, whether or not a
// beam hits it: a flight that moves on fills the gaps between the rings of a LiDAR. The vehicle is level, and
// its cameras may have any heading.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "plugins/simulator/cave/ray_scene.h"
#include "plugins/simulator/simulator_options.h"

namespace karst::bound {

/// Sees all between two elevations.
struct Eye {
  core::Vec3 mount = core::Vec3::Zero();  // body frame
  double low_rad = 0, high_rad = 0, range_m = 0;
};

/// A cell counts from whatever range the map frees it: that of the mission for the LiDAR, a camera's own.
std::vector<Eye> eyes_of(const sim::SimulatorOptions& vehicle, double mapping_range_m);

/// Those of `which` (numbers of `centres`) that are seen from `place`, in their order.
std::vector<std::uint32_t> seen_from(const cave::RayScene& scene, const std::vector<Eye>& eyes,
                                     const core::Vec3& place, std::span<const core::Vec3> centres,
                                     std::span<const std::uint32_t> which);

}  // namespace karst::bound
