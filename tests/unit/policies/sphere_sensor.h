// A sensor that sees all around, for tests of policies that ask what a look would show.
#pragma once
#include <karst/types.h>

namespace karst::test {

inline Sensor sphere_sensor(double range_m) {
  constexpr double pi = 3.14159265358979323846;
  Sensor s{};
  s.kind = KARST_SENSOR_LIDAR;
  s.T_body_sensor.orientation.w = 1;
  s.max_range_m = range_m;
  s.horizontal_fov_rad = 2 * pi;
  s.low_elevation_rad = -pi / 2;
  s.high_elevation_rad = pi / 2;
  return s;
}

}  // namespace karst::test
