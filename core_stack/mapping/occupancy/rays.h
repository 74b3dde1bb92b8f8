// Converts a sensor's message to rays in the world frame, each from the sensor's position when it fired.
#pragma once
#include <vector>

#include "core_stack/localization/state.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core {

struct Ray {
  Vec3f origin, end;  // world frame; end is the hit, or the end of the free part
  bool hit = false;
};

/// Compensates the motion during the sweep with the poses in `history` (one per column). Drops returns that
/// are NaN or nearer than `self_radius_m` to the body's origin. A return beyond `max_range_m`, or +inf, only
/// clears space up to that range. A scan whose arrays do not fit its model gives no rays. Order: by column,
/// then by channel.
std::vector<Ray> to_rays(const LidarScan& scan, const StateHistory& history, double self_radius_m,
                         double max_range_m);
/// The same for a depth image, taken at one instant, with the range limit of its model. Order: row-major.
std::vector<Ray> to_rays(const DepthImage& image, const StateHistory& history, double self_radius_m);

}  // namespace karst::core
