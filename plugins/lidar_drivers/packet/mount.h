// Where a sensor is mounted, as an option says it.
#pragma once
#include <string>

#include "core_stack/common/geometry.h"

namespace karst::lidar {

/// "x y z roll pitch yaw" in m and degrees: the sensor's frame in the body's. Yaw turns first seen from the
/// body (rotations about z, then y, then x). Throws InputError naming `source` and `key`.
core::Pose mount_of(const std::string& source, const std::string& key, const std::string& text);

}  // namespace karst::lidar
