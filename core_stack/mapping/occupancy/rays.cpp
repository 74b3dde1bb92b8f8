#include "core_stack/mapping/occupancy/rays.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace karst::core {
namespace {

/// A sensor at the pose at which it fired.
struct Sensor {
  Vec3f origin;
  Eigen::Matrix3f R_world_sensor;
  explicit Sensor(const Pose& T_world_sensor)
      : origin(T_world_sensor.position.cast<float>()),
        R_world_sensor(T_world_sensor.orientation.toRotationMatrix().cast<float>()) {}
};

/// Accepts the returns that become rays: rejects hits on the vehicle itself and invalid ranges.
struct Gate {
  Vec3f sensor_in_body;
  Eigen::Matrix3f R_body_sensor;
  float self_radius_m, max_range_m;

  Gate(const Pose& T_body_sensor, double self_radius, double max_range)
      : sensor_in_body(T_body_sensor.position.cast<float>()),
        R_body_sensor(T_body_sensor.orientation.toRotationMatrix().cast<float>()),
        self_radius_m(static_cast<float>(self_radius)),
        max_range_m(static_cast<float>(max_range)) {}

  /// `direction` is a unit vector in the sensor's frame, in which the ranges count from `origin`.
  void cast(const Sensor& sensor, const Vec3f& direction, float range_m, std::vector<Ray>& rays,
            const Vec3f& origin = Vec3f::Zero()) const {
    if (!(range_m > 0)) return;  // NaN as well
    const Vec3f return_in_body =
        sensor_in_body + R_body_sensor * origin + R_body_sensor * direction * range_m;
    if (return_in_body.squaredNorm() < self_radius_m * self_radius_m) return;
    const bool hit = range_m <= max_range_m;
    rays.push_back({sensor.origin,
                    sensor.origin + sensor.R_world_sensor * direction * std::min(range_m, max_range_m), hit});
  }
};

/// With a LiDAR without rings, the pose of the sensor is renewed after this time: 0.5 mm at 5 m/s.
constexpr TimeNs kSamePose = 100'000;

/// Directions of all beams from one row and one column: cos and sin once per row, not once per beam.
struct BeamTable {
  std::vector<Eigen::Vector2f> azimuth;    // unit, one per column
  std::vector<Eigen::Vector2f> elevation;  // (cos, sin), one per channel
  std::vector<Eigen::Vector2f> offset;     // (cos, sin), one per channel, or none
  explicit BeamTable(const LidarModel& model) {
    const auto& e = model.elevation_rad;
    const auto flattest =
        std::min_element(e.begin(), e.end(), [](float a, float b) { return std::abs(a) < std::abs(b); });
    const int channel = static_cast<int>(flattest - e.begin());
    for (int j = 0; j < model.columns; ++j)
      azimuth.push_back(model.direction(channel, j).head<2>().normalized());
    for (const float a : e) elevation.emplace_back(std::cos(a), std::sin(a));
    if (model.azimuth_offset_rad.empty()) return;
    // The azimuths are those of the flattest channel, with its offset.
    const float at = model.azimuth_offset_rad[static_cast<std::size_t>(channel)];
    for (const float a : model.azimuth_offset_rad) offset.emplace_back(std::cos(a - at), std::sin(a - at));
  }
  Vec3f direction(std::size_t channel, std::size_t column) const {
    Eigen::Vector2f h = elevation[channel].x() * azimuth[column];
    if (!offset.empty()) {
      const Eigen::Vector2f& o = offset[channel];
      h = {o.x() * h.x() - o.y() * h.y(), o.y() * h.x() + o.x() * h.y()};
    }
    return {h.x(), h.y(), elevation[channel].y()};
  }
};

std::vector<Ray> rays_of_points(const LidarScan& scan, const StateHistory& history, const Gate& gate) {
  std::vector<Ray> rays;
  rays.reserve(scan.range_m.size());
  std::optional<Sensor> sensor;
  TimeNs posed = 0;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    const TimeNs fired = scan.fired(i);
    if (!sensor || std::abs(fired - posed) > kSamePose) {
      sensor.emplace(history.pose_at(fired) * scan.model->T_body_lidar);
      posed = fired;
    }
    gate.cast(*sensor, scan.direction[i], scan.range_m[i], rays);
  }
  return rays;
}

}  // namespace

std::vector<Ray> to_rays(const LidarScan& scan, const StateHistory& history, double self_radius_m,
                         double max_range_m) {
  std::vector<Ray> rays;
  if (!scan.fits_model()) return rays;
  const LidarModel& model = *scan.model;
  const Gate gate(model.T_body_lidar, self_radius_m, std::min<double>(max_range_m, model.max_range_m));
  if (!model.has_rings()) return rays_of_points(scan, history, gate);

  const auto columns = static_cast<std::size_t>(model.columns), channels = model.elevation_rad.size();
  const BeamTable beams(model);
  rays.reserve(scan.range_m.size());
  for (std::size_t j = 0; j < columns; ++j) {
    Sensor sensor(history.pose_at(scan.fired(j)) * model.T_body_lidar);
    const Vec3f origin = model.origin(static_cast<int>(j));
    sensor.origin += sensor.R_world_sensor * origin;
    for (std::size_t c = 0; c < channels; ++c)
      gate.cast(sensor, beams.direction(c, j), scan.range_m[c * columns + j], rays, origin);
  }
  return rays;
}

std::vector<Ray> to_rays(const DepthImage& image, const StateHistory& history, double self_radius_m) {
  std::vector<Ray> rays;
  if (!image.model || image.model->width <= 0 || image.model->height <= 0) return rays;
  const CameraModel& model = *image.model;
  const auto width = static_cast<std::size_t>(model.width), height = static_cast<std::size_t>(model.height);
  if (image.range_m.size() != width * height) return rays;

  // Pinhole: a pixel's direction is (1, u, v) before normalization, u by its column and v by its row.
  std::vector<float> u(width), v(height);
  for (std::size_t i = 0; i < width; ++i) {
    const Vec3f d = model.direction(0, static_cast<int>(i));
    u[i] = d.y() / d.x();
  }
  for (std::size_t i = 0; i < height; ++i) {
    const Vec3f d = model.direction(static_cast<int>(i), 0);
    v[i] = d.z() / d.x();
  }
  const Gate gate(model.T_body_camera, self_radius_m, model.max_range_m);
  const Sensor sensor(history.pose_at(image.stamp) * model.T_body_camera);
  rays.reserve(image.range_m.size());
  for (std::size_t row = 0; row < height; ++row)
    for (std::size_t column = 0; column < width; ++column)
      gate.cast(sensor, Vec3f(1.0f, u[column], v[row]).normalized(), image.range_m[row * width + column],
                rays);
  return rays;
}

}  // namespace karst::core
