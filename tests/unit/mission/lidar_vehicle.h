// A vehicle with a small LiDAR, for tests that need no other sensor.
#pragma once
#include <memory>

#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

inline VehicleDescription with_lidar() {
  VehicleDescription v;
  auto lidar = std::make_shared<LidarModel>();
  lidar->columns = 8;
  lidar->elevation_rad = {0.5f, -0.5f};
  v.lidar = lidar;
  return v;
}

}  // namespace karst::core
