#include "tests/benchmark/offline_bound/sight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace karst::bound {
namespace {

using core::Vec3;

/// Between its optical axis and the corner of its image.
double half_diagonal_rad(const core::CameraModel& m) {
  return std::atan(std::hypot(std::tan(m.horizontal_fov_rad / 2), std::tan(m.vertical_fov_rad / 2)));
}

/// Sines, because a flight asks for millions of cells.
struct View {
  double low, high, range_squared;
  explicit View(const Eye& e)
      : low(std::sin(e.low_rad)), high(std::sin(e.high_rad)), range_squared(e.range_m * e.range_m) {}
  bool contains(const Vec3& to, double squared) const {
    const double length = std::sqrt(squared);
    return squared <= range_squared && to.z() >= low * length && to.z() <= high * length;
  }
};

}  // namespace

std::vector<Eye> eyes_of(const sim::SimulatorOptions& vehicle, double mapping_range_m) {
  std::vector<Eye> eyes;
  if (vehicle.vehicle == sim::VehiclePreset::camera_uav) return eyes;
  const auto lidar = sim::lidar_model(vehicle.lidar);
  const auto [low, high] = std::minmax_element(lidar->elevation_rad.begin(), lidar->elevation_rad.end());
  eyes.push_back({lidar->T_body_lidar.position, static_cast<double>(*low), static_cast<double>(*high),
                  std::min(mapping_range_m, static_cast<double>(lidar->max_range_m))});
  if (vehicle.vehicle != sim::VehiclePreset::lidar_uav) return eyes;
  const auto up = sim::camera_model(vehicle.camera, sim::Facing::up),
             down = sim::camera_model(vehicle.camera, sim::Facing::down);
  const double right_angle = std::numbers::pi / 2;
  eyes.push_back({up->T_body_camera.position, right_angle - half_diagonal_rad(*up), right_angle,
                  static_cast<double>(up->max_range_m)});
  eyes.push_back({down->T_body_camera.position, -right_angle, half_diagonal_rad(*down) - right_angle,
                  static_cast<double>(down->max_range_m)});
  return eyes;
}

std::vector<std::uint32_t> seen_from(const cave::RayScene& scene, const std::vector<Eye>& eyes,
                                     const Vec3& place, std::span<const Vec3> centres,
                                     std::span<const std::uint32_t> which) {
  constexpr float kRounding_m = 1e-3f;
  std::vector<std::uint32_t> left(which.begin(), which.end()), asked, seen;
  std::vector<cave::Ray> rays;
  std::vector<float> lengths_m;
  std::vector<cave::Hit> hits;
  for (const Eye& eye : eyes) {
    const Vec3 from = place + eye.mount;
    const View view(eye);
    asked.clear(), rays.clear(), lengths_m.clear();
    for (const std::uint32_t i : left) {
      const Vec3 to = centres[i] - from;
      const double squared = to.squaredNorm();
      if (!view.contains(to, squared)) continue;
      const double length_m = std::sqrt(squared);
      asked.push_back(i);
      rays.push_back({from.cast<float>(), (to / length_m).cast<float>()});
      lengths_m.push_back(static_cast<float>(length_m));
    }
    hits.resize(rays.size());
    scene.cast(rays, static_cast<float>(eye.range_m), hits);
    std::vector<std::uint32_t> now;
    for (std::size_t i = 0; i < asked.size(); ++i)
      if (hits[i].range_m + kRounding_m >= lengths_m[i]) now.push_back(asked[i]);
    std::vector<std::uint32_t> rest;
    std::set_difference(left.begin(), left.end(), now.begin(), now.end(), std::back_inserter(rest));
    left = std::move(rest);
    seen.insert(seen.end(), now.begin(), now.end());
  }
  std::sort(seen.begin(), seen.end());
  return seen;
}

}  // namespace karst::bound
