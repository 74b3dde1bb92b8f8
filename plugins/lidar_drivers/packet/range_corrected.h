// Reflectivity, which sensors correct for range, and karst's intensity, which falls with it.
#pragma once

namespace karst::lidar {

/// 1 + (r / 25 m)^2: by how much intensity lies below reflectivity (LidarScan; perception/lonely_returns.h).
inline float intensity_fall_off(float range_m) { return 1 + (range_m / 25) * (range_m / 25); }

}  // namespace karst::lidar
