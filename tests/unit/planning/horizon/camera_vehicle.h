// A vehicle with one depth camera, 79 x 63 degrees, for the tests of motion with a receding horizon.
#pragma once
#include <memory>

#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

inline VehicleDescription camera_vehicle() {
  auto camera = std::make_shared<CameraModel>();
  camera->horizontal_fov_rad = 1.38;
  camera->vertical_fov_rad = 1.1;
  VehicleDescription vehicle;
  vehicle.cameras.push_back(camera);
  return vehicle;
}

}  // namespace karst::core
