#include "core_stack/localization/sweep.h"

#include <cmath>
#include <tuple>

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

/// Takes the returns that become points.
class Collector {
 public:
  Collector(const LidarModel& model, double self_radius_m, Sweep& sweep)
      : body_in_lidar_(model.T_body_lidar.inverse().position.cast<float>()),
        self_radius_m_(static_cast<float>(self_radius_m)),
        sweep_(sweep) {}
  static bool is_return(float range_m) { return std::isfinite(range_m) && range_m > 0; }
  void take(const SweepPoint& p) {
    if ((p.position - body_in_lidar_).squaredNorm() < self_radius_m_ * self_radius_m_) return;
    sweep_.points.push_back(p);
  }

 private:
  Vec3f body_in_lidar_;
  float self_radius_m_;
  Sweep& sweep_;
};

void collect_rings(const LidarScan& scan, Collector& collector) {
  const LidarModel& model = *scan.model;
  const auto columns = static_cast<std::size_t>(model.columns);
  const bool has_intensity = scan.intensity.size() == scan.range_m.size();
  Beams table(model);
  if (!scan.time_s.empty()) table.time_s = scan.time_s;
  const bool turned = !model.azimuth_offset_rad.empty();
  for (std::size_t ring = 0, i = 0; ring < model.elevation_rad.size(); ++ring) {
    const float flat = std::cos(model.elevation_rad[ring]), up = std::sin(model.elevation_rad[ring]);
    const float c = turned ? std::cos(model.azimuth_offset_rad[ring]) : 1;
    const float s = turned ? std::sin(model.azimuth_offset_rad[ring]) : 0;
    for (std::size_t j = 0; j < columns; ++j, ++i) {
      const float range = scan.range_m[i];
      if (!Collector::is_return(range)) continue;
      float x = table.cos_azimuth[j], y = table.sin_azimuth[j];
      if (turned) std::tie(x, y) = std::pair(c * x - s * y, s * x + c * y);
      Vec3f p = range * Vec3f(flat * x, flat * y, up);
      if (model.beam_origin_m != 0)
        p += model.beam_origin_m * Vec3f(table.cos_azimuth[j], table.sin_azimuth[j], 0);
      collector.take(
          {p, table.time_s[j], static_cast<std::uint16_t>(ring), has_intensity ? scan.intensity[i] : 0.0f});
    }
  }
}

void collect_points(const LidarScan& scan, Collector& collector) {
  const bool has_intensity = scan.intensity.size() == scan.range_m.size();
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (Collector::is_return(scan.range_m[i]))
      collector.take(
          {scan.range_m[i] * scan.direction[i], scan.time_s[i], 0, has_intensity ? scan.intensity[i] : 0.0f});
}

}  // namespace

Sweep to_sweep(const LidarScan& scan, double self_radius_m) {
  Sweep sweep;
  sweep.stamp = scan.stamp;
  if (!scan.fits_model() || scan.model->elevation_rad.size() > 0xffff) return sweep;
  sweep.T_body_lidar = scan.model->T_body_lidar;
  sweep.has_rings = scan.model->has_rings();
  sweep.points.reserve(scan.range_m.size());
  Collector collector(*scan.model, self_radius_m, sweep);
  if (sweep.has_rings)
    collect_rings(scan, collector);
  else
    collect_points(scan, collector);
  return sweep;
}

}  // namespace karst::core
