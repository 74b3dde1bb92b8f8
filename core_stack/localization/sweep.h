// One sweep of a LiDAR as points, independent of the source: simulator, vehicle, or file.
#pragma once
#include <cstdint>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core {

struct SweepPoint {
  Vec3f position;          // lidar frame at the time it was measured
  float time_s = 0;        // relative to the sweep's stamp, <= 0
  std::uint16_t ring = 0;  // channel; 0 without rings
  float intensity = 0;
};

struct Sweep {
  TimeNs stamp = 0;                // of the last point
  std::vector<SweepPoint> points;  // sorted by ring; within a ring, or without rings, in firing order
  Pose T_body_lidar;
  bool has_rings = true;
  bool compensated = false;  // all points are already motion-compensated to `stamp`
};

/// The returns of a scan as points. Drops NaN, inf, and returns nearer than `self_radius_m` to the body's
/// origin, which come from the vehicle itself. A scan gives no points if it has no model or its arrays do not
/// fit the model.
Sweep to_sweep(const LidarScan& scan, double self_radius_m);

}  // namespace karst::core
