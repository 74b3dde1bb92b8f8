// A LiDAR without noise, for the tests that compare ranges with a closed form.
#pragma once
#include "core_stack/common/time.h"
#include "plugins/simulator/sensors/lidar.h"

namespace karst::test {

/// The end of a sweep that begins at 0.
constexpr core::TimeNs kEnd = 100 * core::kMillisecond;

inline sim::LidarOptions exact(const char* unit, int columns) {
  sim::LidarOptions o;
  o.unit = unit;
  o.columns = columns;
  o.noise_m = 0;
  return o;
}

}  // namespace karst::test
