// A recorded scan as stored in its file, before the sensor is known.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::replay {

struct ScanPoint {
  core::Vec3f position = core::Vec3f::Zero();  // metres, the sensor's frame
  float intensity = 0;                         // in the file's own unit
  double time = 0;                             // in the file's own unit
  std::uint16_t ring = 0;
};

struct Scan {
  std::vector<ScanPoint> points;  // finite positions only, in the file's order
  bool has_intensity = false, has_time = false, has_ring = false;
  bool time_is_whole = false;  // stored as an integer
  std::size_t dropped = 0;     // points of the file that were not finite
};

}  // namespace karst::replay
