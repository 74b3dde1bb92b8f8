// A LiDAR without rings in a world in closed form: its beams are scattered evenly over a belt of the sphere,
// and elsewhere in each sweep.
#pragma once
#include "tests/unit/localization/worlds.h"

namespace karst::test {

inline std::shared_ptr<core::LidarModel> scattered_lidar() {
  auto model = std::make_shared<core::LidarModel>();
  model->elevation_rad = {0.9f, -0.12f};
  model->max_range_m = 70;
  model->T_body_lidar = {{0.05, -0.02, 0.1}, core::exp_so3({0, 0.02, 0.3})};
  return model;
}

inline core::LidarScan scattered_scan(const World& world,
                                      const std::shared_ptr<const core::LidarModel>& model,
                                      const Motion& T_world_body, TimeNs stamp, double noise_m,
                                      core::Random random, int points = 20000) {
  core::LidarScan scan{stamp, model, {}, {}};
  const double low = std::sin(static_cast<double>(model->elevation_rad.back())),
               high = std::sin(static_cast<double>(model->elevation_rad.front()));
  const double turn = random.uniform(0, 6.28), shift = random.uniform();
  for (int i = 0; i < points; ++i) {
    const double fraction = (i + shift) / points;
    // The golden angle in azimuth and another irrational step in height cover the belt evenly at any time.
    const double azimuth = turn + 2.399963 * i, z = low + (high - low) * std::fmod(0.754877 * i + shift, 1.0);
    const Vec3 d(std::sqrt(1 - z * z) * std::cos(azimuth), std::sqrt(1 - z * z) * std::sin(azimuth), z);
    const TimeNs fired = stamp - static_cast<TimeNs>((1 - fraction) * static_cast<double>(model->period));
    const Pose T = T_world_body(fired) * model->T_body_lidar;
    const double range = world(T.position, T.orientation * d);
    if (!(range < static_cast<double>(model->max_range_m))) continue;
    scan.range_m.push_back(static_cast<float>(range + noise_m * random.normal()));
    scan.intensity.push_back(0.1f);
    scan.direction.push_back(d.cast<float>());
    scan.time_s.push_back(static_cast<float>(core::seconds(fired - stamp)));
  }
  return scan;
}

}  // namespace karst::test
