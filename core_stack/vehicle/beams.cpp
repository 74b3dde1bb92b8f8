#include <cmath>
#include <numbers>

#include "core_stack/vehicle/messages.h"

namespace karst::core {

Vec3f LidarModel::direction(int channel, int column) const {
  const float azimuth = std::numbers::pi_v<float> *
                        (1.0f - 2.0f * (static_cast<float>(column) + 0.5f) / static_cast<float>(columns));
  const float elevation = elevation_rad[static_cast<std::size_t>(channel)];
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

Vec3f CameraModel::direction(int row, int column) const {
  const double u = 1.0 - 2.0 * (column + 0.5) / width;  // +1 at the left edge
  const double v = 1.0 - 2.0 * (row + 0.5) / height;    // +1 at the top edge
  const Eigen::Vector3d d(1.0, u * std::tan(horizontal_fov_rad / 2), v * std::tan(vertical_fov_rad / 2));
  return d.normalized().cast<float>();
}

}  // namespace karst::core
