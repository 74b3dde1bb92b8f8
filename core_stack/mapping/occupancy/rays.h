// From a sensor's message to rays in the world frame, each cast from where the sensor was when it fired.
#pragma once
#include <vector>

#include "core_stack/localization/state.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core {

struct Ray {
  Vec3f origin, end;  // world frame; end is the hit, or the point up to which nothing was seen
  bool hit = false;
};

/// Removes the sweep's distortion with the poses in `history` (one a column); returns that are NaN or nearer
/// than `self_radius_m` to the body's origin are dropped. What lies beyond `max_range_m`, and +inf, only
/// clears space up to it. A scan whose arrays do not fit its model gives no rays. Order: by column, then by
/// channel.
std::vector<Ray> to_rays(const LidarScan& scan, const StateHistory& history, double self_radius_m,
                         double max_range_m);
/// The same for a depth image, taken at one moment; its range ends where the model's does. Order: row-major.
std::vector<Ray> to_rays(const DepthImage& image, const StateHistory& history, double self_radius_m);

}  // namespace karst::core
