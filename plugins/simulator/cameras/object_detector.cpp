#include "plugins/simulator/cameras/object_detector.h"

#include <algorithm>
#include <cmath>

namespace karst::sim {

using core::ObjectDetection;
using core::ObjectKind;
using core::Random;
using core::Vec3;

namespace {

constexpr double kMinLux = 2, kMinClear = 0.1;

/// Two unit vectors perpendicular to `d` and to each other.
std::pair<Vec3, Vec3> across(const Vec3& d) {
  const Vec3 a = d.cross(std::abs(d.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX()).normalized();
  return {a, d.cross(a)};
}

}  // namespace

std::vector<InView> ObjectDetector::in_view(const cave::Cave& cave, const core::Pose& T_world_camera,
                                            const core::CameraModel& camera, Light light,
                                            std::span<const cave::Cloud> clouds) const {
  const core::Pose T_camera_world = T_world_camera.inverse();
  const Vec3& eye = T_world_camera.position;
  const double range_m = std::min(options_.range_m, static_cast<double>(camera.max_range_m));
  const double wide = std::tan(camera.horizontal_fov_rad / 2), high = std::tan(camera.vertical_fov_rad / 2);
  std::vector<InView> seen;
  CloudyPath path;
  for (std::size_t i = 0; i < cave.description.objects.size(); ++i) {
    const cave::CaveObject& o = cave.description.objects[i];
    const double away_m = (o.position - eye).norm();
    if (away_m > range_m || away_m < static_cast<double>(camera.min_range_m)) continue;
    const Vec3 place = T_camera_world * o.position;
    if (place.x() <= 0 || std::abs(place.y()) > place.x() * wide || std::abs(place.z()) > place.x() * high)
      continue;
    const Vec3 sight = (o.position - eye) / away_m;
    const double cosine = o.normal.isZero() ? 1 : -sight.dot(o.normal);
    if (cosine < std::cos(options_.max_incidence_rad)) continue;
    if (light == Light::lamp) {  // the lamp is beside the lens
      const double fraction =
          static_cast<double>(beam_fraction(rgb_, static_cast<float>(place.x() / away_m)));
      if (rgb_.intensity_cd * fraction * cosine / (away_m * away_m) < kMinLux) continue;
    }
    if (cave.scene.ray_cast(eye, sight, away_m) < away_m) continue;
    double clear = 1;
    if (!clouds.empty()) {
      path.trace(clouds, {eye.cast<float>(), sight.cast<float>()});
      clear = path.two_way(away_m);
    }
    if (clear < kMinClear) continue;
    seen.push_back({i, place, clear});
  }
  return seen;
}

/// The detection with noise added, and the standard deviation of that noise.
ObjectDetection ObjectDetector::measured(ObjectKind kind, const Vec3& place, Light light,
                                         Random& random) const {
  ObjectDetection d;
  d.kind = kind;
  const double range_m = place.norm();
  d.bearing_sigma_rad = options_.bearing_noise_rad;
  const double fraction = light == Light::lamp ? options_.size_noise : options_.depth_noise;
  d.range_m = std::max(0.1, range_m * (1 + fraction * random.normal()));
  d.range_sigma_m = fraction * d.range_m;  // from the measured range, as a detector would
  const Vec3 u = place / range_m;
  const auto [a, b] = across(u);
  const double off_a = d.bearing_sigma_rad * random.normal(), off_b = d.bearing_sigma_rad * random.normal();
  d.direction = (u + off_a * a + off_b * b).normalized();
  return d;
}

std::vector<ObjectDetection> ObjectDetector::detect(const cave::Cave& cave, const core::Pose& T_world_camera,
                                                    const core::CameraModel& camera, Light light,
                                                    const std::vector<InView>& in_view, Random random) const {
  std::vector<ObjectDetection> found;
  for (const InView& o : in_view) {
    const bool recognized = random.uniform() < options_.detection * o.clear;
    ObjectDetection d = measured(cave.description.objects[o.object].kind, o.place, light, random);
    d.confidence = random.uniform(0.5, 1);
    if (recognized) found.push_back(d);
  }
  const double per_image = options_.false_per_min * core::seconds(camera.period) / 60;
  if (random.uniform() < per_image) {  // rock that looks like something
    const double wide = std::tan(camera.horizontal_fov_rad / 2), high = std::tan(camera.vertical_fov_rad / 2);
    // One statement a draw: compilers differ in the order in which they evaluate arguments.
    const double up = random.uniform(-high, high);
    const Vec3 d = Vec3(1, random.uniform(-wide, wide), up).normalized();
    const auto kind = static_cast<ObjectKind>(1 + static_cast<int>(random.uniform() * core::kObjectKinds));
    const double range_m =
        cave.scene.ray_cast(T_world_camera.position, T_world_camera.orientation * d,
                            std::min(options_.range_m, static_cast<double>(camera.max_range_m)));
    if (std::isfinite(range_m) && range_m > 0.1) {
      ObjectDetection wrong = measured(kind, range_m * d, light, random);
      wrong.confidence = random.uniform(0.3, 0.7);
      found.push_back(wrong);
    }
  }
  return found;
}

}  // namespace karst::sim
