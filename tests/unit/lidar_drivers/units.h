// Small sensors and what they see, for the tests of this folder.
#pragma once
#include <cmath>
#include <limits>

#include "plugins/lidar_drivers/ouster/encoder.h"
#include "tests/unit/localization/worlds.h"

namespace karst::test {

/// An Ouster sensor with beams as uneven as real ones: each has its own azimuth, and leaves 27.67 mm off the
/// axis.
inline lidar::OusterMetadata uneven_ouster(lidar::OusterProfile profile, int columns = 64) {
  lidar::OusterMetadata m;
  m.product = "OS-0-8";
  m.serial = 122322000614;
  m.profile = profile;
  m.columns_per_frame = columns;
  m.last_column = columns - 1;
  m.altitude_deg = {44.3, 31.2, 18.9, 6.5, -6.1, -18.4, -31.7, -45.6};
  m.azimuth_deg = {10.85, 3.67, -3.4, -10.32, 8.29, 2.75, -2.77, -8.31};
  m.beam_origin_mm = 27.67;
  m.lidar_to_sensor[11] = 36.18;
  return m;
}

/// What a sensor with such beams sees while it moves through a room, with ranges from the beams' origins.
inline core::LidarScan room_scan(const std::shared_ptr<core::LidarModel>& model, core::TimeNs stamp) {
  const World world = furnished_room();
  core::LidarScan scan{stamp, model, {}, {}};
  scan.range_m.resize(static_cast<std::size_t>(model->columns) * model->elevation_rad.size());
  scan.intensity.resize(scan.range_m.size());
  for (int c = 0, i = 0; c < model->channels(); ++c)
    for (int j = 0; j < model->columns; ++j, ++i) {
      const Vec3 from = model->origin(j).cast<double>(), d = model->direction(c, j).cast<double>();
      const auto at = static_cast<std::size_t>(i);
      const double range = world(from, d);
      scan.range_m[at] = static_cast<float>(std::round(1000 * range) / 1000);
      scan.intensity[at] = 0.01f * static_cast<float>(i % 90);
    }
  scan.range_m[5] = std::numeric_limits<float>::infinity();
  scan.range_m[11] = std::numeric_limits<float>::quiet_NaN();
  return scan;
}

}  // namespace karst::test
