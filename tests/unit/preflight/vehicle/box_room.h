// A vehicle on the floor of a box-shaped room, whose ranges are known in closed form.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "core_stack/common/random.h"
#include "sdk/preflight/vehicle/vehicle_record.h"

namespace karst::test {

/// Extents from the vehicle's centre, m.
struct BoxRoom {
  double half_width_m = 3, below_m = 0.3, above_m = 2.5;

  /// Along a unit vector from `from`, both inside.
  double range_m(const core::Vec3& from, const core::Vec3& direction) const {
    const core::Vec3 low(-half_width_m, -half_width_m, -below_m), high(half_width_m, half_width_m, above_m);
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] > 1e-9) least = std::min(least, (high[axis] - from[axis]) / direction[axis]);
      if (direction[axis] < -1e-9) least = std::min(least, (low[axis] - from[axis]) / direction[axis]);
    }
    return least;
  }
};

inline std::shared_ptr<core::LidarModel> lidar_of(double half_fov_deg = 45) {
  auto model = std::make_shared<core::LidarModel>();
  model->name = "test";
  model->columns = 360;
  for (int i = 0; i < 16; ++i)
    model->elevation_rad.push_back(
        static_cast<float>(half_fov_deg * (1 - 2 * i / 15.0) * std::numbers::pi / 180));
  model->T_body_lidar.position.z() = 0.1;
  return model;
}

inline core::LidarScan scan_of(const BoxRoom& room, const std::shared_ptr<const core::LidarModel>& model,
                               double noise_m = 0, std::uint64_t seed = 1) {
  core::LidarScan scan{0, model, {}, {}};
  core::Random random(seed);
  for (int c = 0; c < model->channels(); ++c)
    for (int j = 0; j < model->columns; ++j) {
      const core::Vec3 d = model->T_body_lidar.orientation * model->direction(c, j).cast<double>();
      scan.range_m.push_back(
          static_cast<float>(room.range_m(model->T_body_lidar.position, d) + noise_m * random.normal()));
      scan.intensity.push_back(0.4f);
    }
  return scan;
}

/// Of `scans` in the room, at rest.
inline preflight::VehicleRecord record_in(const BoxRoom& room,
                                          const std::shared_ptr<const core::LidarModel>& model,
                                          int scans = 10) {
  preflight::VehicleRecord record;
  record.vehicle.lidar = model;
  for (int i = 0; i < scans; ++i)
    record.scans_at_rest.push_back(std::make_shared<const core::LidarScan>(
        scan_of(room, model, 0.02, static_cast<std::uint64_t>(i + 1))));
  return record;
}

}  // namespace karst::test
