// What a vehicle said while it was listened to: first at rest on its pad, then turned by hand.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core_stack/vehicle/vehicle.h"

namespace karst::preflight {

/// When a message was measured, by its own stamp, and when it came.
struct Arrival {
  core::TimeNs stamp = 0, came = 0;
};

struct CameraRecord {
  std::vector<Arrival> arrivals;
  std::vector<std::shared_ptr<const core::DepthImage>> images;  // the first few
};

/// Messages are in the order in which they came.
struct VehicleRecord {
  core::VehicleDescription vehicle;
  core::TimeNs begin = 0, rest_end = 0, end = 0;  // the motion is from rest_end to end
  std::vector<core::ImuSample> imu;
  std::vector<core::MagnetometerSample> magnetometer;
  std::vector<core::BarometerSample> barometer;
  std::vector<core::BatteryStatus> battery;
  std::vector<std::shared_ptr<const core::LidarScan>> scans_at_rest;    // the first few
  std::vector<std::shared_ptr<const core::LidarScan>> scans_in_motion;  // all
  std::vector<Arrival> imu_arrivals, magnetometer_arrivals, barometer_arrivals, battery_arrivals,
      lidar_arrivals, pose_arrivals;
  std::vector<CameraRecord> cameras;  // as in the description
  std::vector<core::VehicleCheck> checks;
  bool lifted_off = false;
  std::string lost;  // why nothing more came; "" if that did not happen

  bool has_motion() const { return end > rest_end; }
};

}  // namespace karst::preflight
