// What a vehicle's record says in figures: the values that the rules judge (vehicle_rules.h).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sdk/preflight/vehicle/axis_map.h"
#include "sdk/preflight/vehicle/hand_eye.h"
#include "sdk/preflight/vehicle/imu_at_rest.h"
#include "sdk/preflight/vehicle/scan_matching.h"
#include "sdk/preflight/vehicle/scan_view.h"
#include "sdk/preflight/vehicle/timeline.h"

namespace karst::preflight {

enum class Sensor { imu, lidar, camera, pose, magnetometer, barometer, battery };
constexpr auto names_of(Sensor) {
  using enum Sensor;
  return std::to_array<core::Named<Sensor>>({{imu, "IMU"},
                                             {lidar, "LiDAR"},
                                             {camera, "depth camera"},
                                             {pose, "pose sensor"},
                                             {magnetometer, "compass"},
                                             {barometer, "barometer"},
                                             {battery, "battery"}});
}

struct SensorTimeline {
  Sensor sensor = Sensor::imu;
  std::string name;        // of one of several cameras
  double required_hz = 0;  // as the description says, or as the core needs
  Timeline timeline;
};

struct CompassFigures {
  double strength_ut = 0, noise_ut = 0;  // at rest
  double dip_rad = 0;                    // of the field below the horizontal, by the accelerometer
  double strength_spread = 0;            // in motion: standard deviation of the strength over its mean
  std::optional<AxisTest> by_gyroscope, by_lidar;  // in motion
};

struct BarometerFigures {
  double noise_m = 0, drift_m = 0;
  bool frozen = false;  // every sample is the same
};

/// What is compared while the vehicle is turned by hand.
struct MotionFigures {
  int scans = 0, matched = 0;                          // of them, by scan matching
  std::optional<HandEye> hand_eye;                     // nothing if too few scans were matched
  AxisTest gyroscope_axes;                             // by gravity
  double clipped = 0;                                  // of the IMU's samples
  std::vector<TurnRate> gyroscope_rates, lidar_rates;  // for a drawing
};

/// The computer that karst runs on, and what it will need there.
struct MachineFacts {
  std::string run_folder;
  std::optional<std::uintmax_t> free_bytes;  // nothing if the folder cannot be examined
  double scans_bytes = 0;                    // what the flight's scans take, at most; 0 without record.scans
  bool clock_plausible = true;               // the date is not before karst was built
  std::string policy, policy_problem;        // why it cannot be loaded; "" if it can
};

struct VehicleMeasurements {
  std::string plugin, mission_file;  // what was listened to, by which mission; "": the defaults of a mission
  core::VehicleDescription vehicle;
  double rest_s = 0, motion_s = 0;
  std::vector<SensorTimeline> sensors;
  ImuAtRest imu;
  std::optional<LidarView> lidar;
  PadRoom room;
  double climb_m = 0;
  std::optional<MotionFigures> motion;
  std::optional<CompassFigures> compass;
  std::optional<BarometerFigures> barometer;
  std::optional<core::BatteryStatus> battery;  // the last
  double home_reserve_s = 0;
  std::vector<core::VehicleCheck> checks;
  bool lifted_off = false;
  std::string lost;
  core::Clock clock = core::Clock::lockstep;
  MachineFacts machine;
};

struct MeasureOptions {
  double climb_m = 0.7, home_reserve_s = 20;
  core::LoamOptions loam;
};

/// All but `plugin`, `mission_file`, `clock` and `machine`.
VehicleMeasurements measure(const VehicleRecord& record, const MeasureOptions& options);

/// `run_folder` may be to be created.
MachineFacts machine_facts(const std::string& run_folder);

/// What record.scans writes in a second, if every beam of a scan returns; 0 without a LiDAR.
double scans_bytes_per_s(const VehicleRecord& record);

}  // namespace karst::preflight
