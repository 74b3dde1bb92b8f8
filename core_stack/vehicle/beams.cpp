#include <cmath>
#include <numbers>

#include "core_stack/vehicle/messages.h"

namespace karst::core {

namespace {

float azimuth_of(const LidarModel& model, int column) {
  return std::numbers::pi_v<float> *
         (1.0f - 2.0f * (static_cast<float>(column) + 0.5f) / static_cast<float>(model.columns));
}

}  // namespace

Vec3f LidarModel::direction(int channel, int column) const {
  float azimuth = azimuth_of(*this, column);
  if (!azimuth_offset_rad.empty()) azimuth += azimuth_offset_rad[static_cast<std::size_t>(channel)];
  const float elevation = elevation_rad[static_cast<std::size_t>(channel)];
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

Vec3f LidarModel::origin(int column) const {
  if (beam_origin_m == 0) return Vec3f::Zero();
  const float azimuth = azimuth_of(*this, column);
  return {beam_origin_m * std::cos(azimuth), beam_origin_m * std::sin(azimuth), 0};
}

TimeNs LidarScan::fired(std::size_t j) const {
  if (!time_s.empty()) return stamp + from_seconds(static_cast<double>(time_s[j]));
  return stamp - model->period + model->period * static_cast<TimeNs>(j + 1) / model->columns;
}

bool LidarScan::fits_model() const {
  if (!model) return false;
  if (!model->has_rings()) return direction.size() == range_m.size() && time_s.size() == range_m.size();
  const auto columns = static_cast<std::size_t>(model->columns), channels = model->elevation_rad.size();
  return channels > 0 && range_m.size() == columns * channels &&
         (time_s.empty() || time_s.size() == columns) &&
         (model->azimuth_offset_rad.empty() || model->azimuth_offset_rad.size() == channels);
}

Vec3f CameraModel::direction(int row, int column) const {
  const double u = 1.0 - 2.0 * (column + 0.5) / width;  // +1 at the left edge
  const double v = 1.0 - 2.0 * (row + 0.5) / height;    // +1 at the top edge
  const Eigen::Vector3d d(1.0, u * std::tan(horizontal_fov_rad / 2), v * std::tan(vertical_fov_rad / 2));
  return d.normalized().cast<float>();
}

}  // namespace karst::core
