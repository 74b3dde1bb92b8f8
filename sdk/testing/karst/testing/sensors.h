// The sensors of the simulated vehicles, with the default figures of karst's simulator.
#pragma once
#include <cmath>

#include <karst/types.h>

namespace karst::testing {

/// As simulator.lidar: an Ouster OS0-32, all around, 90 degrees high, 10 cm above the vehicle's centre. What
/// it would see is counted cell by cell in a drawn map: there a shorter range saves much time.
inline Sensor lidar(double max_range_m = 50) {
  constexpr double pi = 3.14159265358979323846;
  Sensor s{};
  s.name = {"os0_32", 6};
  s.kind = KARST_SENSOR_LIDAR;
  s.T_body_sensor = {{0, 0, 0.1}, {1, 0, 0, 0}};
  s.min_range_m = 0.3;
  s.max_range_m = max_range_m;
  s.horizontal_fov_rad = 2 * pi;
  s.low_elevation_rad = -pi / 4;
  s.high_elevation_rad = pi / 4;
  return s;
}

enum class Facing { forward, up, down };

/// As simulator.camera. Forward, of the vehicle camera_uav: 79 x 64 degrees, 4.5 m. Up and down, of
/// lidar_uav: 86 x 58 degrees, 5 m.
inline Sensor depth_camera(Facing facing = Facing::forward) {
  constexpr double degree = 3.14159265358979323846 / 180;
  const bool forward = facing == Facing::forward;
  const double up = facing == Facing::up ? 1 : facing == Facing::down ? -1 : 0;
  Sensor s{};
  s.name = forward ? karst_text_t{"forward", 7} : up > 0 ? karst_text_t{"up", 2} : karst_text_t{"down", 4};
  s.kind = KARST_SENSOR_CAMERA;
  s.T_body_sensor.position = {forward ? 0.15 : 0.0, 0, 0.1 * up};
  const double pitch_rad = -90 * degree * up;  // about y: the optical axis x turns to the body's z
  s.T_body_sensor.orientation = {std::cos(pitch_rad / 2), 0, std::sin(pitch_rad / 2), 0};
  s.min_range_m = 0.2;
  s.max_range_m = forward ? 4.5 : 5.0;
  s.horizontal_fov_rad = (forward ? 79 : 86) * degree;
  s.high_elevation_rad = (forward ? 32 : 29) * degree;
  s.low_elevation_rad = -s.high_elevation_rad;
  return s;
}

}  // namespace karst::testing
