#include "core_stack/localization/sweep.h"

#include <cmath>

namespace karst::core {
namespace {

/// Sines and cosines of the model's angles: a beam's direction then takes three products.
struct Beams {
  std::vector<float> cos_azimuth, sin_azimuth, time_s;

  explicit Beams(const LidarModel& model) {
    for (int j = 0; j < model.columns; ++j) {
      const float azimuth = std::numbers::pi_v<float> * (1.0f - 2.0f * (static_cast<float>(j) + 0.5f) /
                                                                    static_cast<float>(model.columns));
      cos_azimuth.push_back(std::cos(azimuth));
      sin_azimuth.push_back(std::sin(azimuth));
      const double fraction = static_cast<double>(j + 1) / model.columns;
      time_s.push_back(static_cast<float>(seconds(model.period) * (fraction - 1)));
    }
  }
};

}  // namespace

Sweep to_sweep(const LidarScan& scan, double self_radius_m) {
  Sweep sweep;
  sweep.stamp = scan.stamp;
  if (!scan.model || scan.model->columns <= 0) return sweep;
  const LidarModel& model = *scan.model;
  sweep.T_body_lidar = model.T_body_lidar;
  const auto columns = static_cast<std::size_t>(model.columns);
  const std::size_t beams = columns * model.elevation_rad.size();
  if (scan.range_m.size() != beams || model.elevation_rad.size() > 0xffff) return sweep;
  const bool has_intensity = scan.intensity.size() == beams;

  const Beams table(model);
  const Vec3f body_in_lidar = model.T_body_lidar.inverse().position.cast<float>();
  const auto self_radius = static_cast<float>(self_radius_m);
  sweep.points.reserve(beams);
  for (std::size_t ring = 0, i = 0; ring < model.elevation_rad.size(); ++ring) {
    const float flat = std::cos(model.elevation_rad[ring]), up = std::sin(model.elevation_rad[ring]);
    for (std::size_t j = 0; j < columns; ++j, ++i) {
      const float range = scan.range_m[i];
      if (!std::isfinite(range) || range <= 0) continue;
      const Vec3f p = range * Vec3f(flat * table.cos_azimuth[j], flat * table.sin_azimuth[j], up);
      if ((p - body_in_lidar).squaredNorm() < self_radius * self_radius) continue;
      sweep.points.push_back(
          {p, table.time_s[j], static_cast<std::uint16_t>(ring), has_intensity ? scan.intensity[i] : 0.0f});
    }
  }
  return sweep;
}

}  // namespace karst::core
