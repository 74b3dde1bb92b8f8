// Measurements of a vehicle against which nothing speaks.
#pragma once
#include "sdk/preflight/vehicle/vehicle_rules.h"

namespace karst::test {

inline preflight::Check check_with(preflight::Outcome outcome) {
  preflight::Check check;
  check.outcome = outcome;
  return check;
}

inline preflight::SensorTimeline steady(preflight::Sensor sensor, double hz, const char* name = "") {
  preflight::SensorTimeline s{sensor, name, hz, {}};
  s.timeline.messages = static_cast<int>(40 * hz);
  s.timeline.rate_hz = hz;
  s.timeline.longest_gap_s = 1 / hz;
  s.timeline.latency_s = 0.01;
  s.timeline.per_second.assign(40, static_cast<int>(hz));
  return s;
}

inline preflight::VehicleMeasurements known_vehicle() {
  using preflight::Sensor;
  preflight::VehicleMeasurements m;
  m.plugin = "mavlink";
  m.mission_file = "cave & co.info";
  m.vehicle.name = "known <vehicle>";
  m.vehicle.lidar = std::make_shared<core::LidarModel>();
  m.rest_s = 15;
  m.motion_s = 25;
  m.sensors = {steady(Sensor::imu, 200),        steady(Sensor::lidar, 10),
               steady(Sensor::camera, 5, "up"), steady(Sensor::magnetometer, 10),
               steady(Sensor::barometer, 5),    steady(Sensor::battery, 0.5)};
  m.imu.samples = 3000;
  m.imu.mean_force_mps2 = {0.1, -0.05, 9.8};
  m.imu.force_noise_mps2 = 0.05;
  m.imu.rate_noise_radps = 0.003;
  m.lidar.emplace();
  m.lidar->scans = 40;
  m.lidar->noise_m = 0.02;
  m.lidar->intensity = 0.3;
  m.room.known = m.room.seen_above = true;
  m.room.above_m = m.room.above_looked_m = 4;
  m.room.around_m = 1.5;
  m.room.around_looked_m = 3;
  m.room.points = {{1, 2, 0.5f}, {1, -2, -0.3f}};
  m.climb_m = 0.7;
  m.motion.emplace();
  m.motion->scans = m.motion->matched = 250;
  m.motion->hand_eye.emplace();
  m.motion->hand_eye->pairs = 240;
  m.motion->hand_eye->explained = 0.999;
  m.motion->hand_eye->sigma_rad = 0.001;
  m.motion->hand_eye->weakest_rate_radps = 0.4;
  m.motion->gyroscope_rates =
      m.motion->lidar_rates = {{0, 0.1}, {core::kSecond, 0.5}, {2 * core::kSecond, 0.3}};
  m.compass.emplace();
  m.compass->strength_ut = 49;
  m.compass->noise_ut = 0.3;
  m.compass->dip_rad = 1.13;
  preflight::AxisTest fits;
  fits.samples = 1000;
  fits.strength = 49;
  fits.scatter = fits.scatter_as_is = 0.5;
  m.compass->by_gyroscope = m.compass->by_lidar = fits;
  m.barometer = preflight::BarometerFigures{0.1, 0.02, false};
  m.battery = core::BatteryStatus{0, 48, 0.97, 30, 580};
  m.home_reserve_s = 20;
  m.checks = {{"COM_OF_LOSS_T", "at most 1 s", "1 s", true}};
  m.machine.run_folder = "runs";
  m.machine.free_bytes = std::uintmax_t{50} << 30;
  m.machine.policy = "nearest_frontier";
  return m;
}

}  // namespace karst::test
