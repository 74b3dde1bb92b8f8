// All options of the mission file's section `simulator`.
#pragma once
#include "plugins/simulator/cameras/depth_camera.h"
#include "plugins/simulator/cameras/rgb_camera.h"
#include "plugins/simulator/dynamics/autopilot.h"
#include "plugins/simulator/dynamics/battery.h"
#include "plugins/simulator/dynamics/motors.h"
#include "plugins/simulator/dynamics/wind.h"
#include "plugins/simulator/environment/cave_air.h"
#include "plugins/simulator/environment/object_options.h"
#include "plugins/simulator/sensors/barometer.h"
#include "plugins/simulator/sensors/imu.h"
#include "plugins/simulator/sensors/lidar.h"
#include "plugins/simulator/sensors/magnetometer.h"
#include "plugins/simulator/sensors/pose_sensor.h"

namespace karst::sim {

/// The set of sensors that the vehicle carries.
enum class VehiclePreset { lidar_uav, lidar_only_uav, camera_uav };
constexpr auto names_of(VehiclePreset) {
  using enum VehiclePreset;
  return std::to_array<core::Named<VehiclePreset>>(
      {{lidar_uav, "lidar_uav"}, {lidar_only_uav, "lidar_only_uav"}, {camera_uav, "camera_uav"}});
}

struct SimulatorOptions {
  VehiclePreset vehicle = VehiclePreset::lidar_uav;
  BatteryOptions battery;
  WindOptions wind;
  AirOptions air;
  LidarOptions lidar;
  CameraOptions camera;
  RgbOptions rgb;
  ObjectOptions objects;
  ImuOptions imu;
  MagnetometerOptions magnetometer;
  BarometerOptions barometer;
  PoseSensorOptions pose;
  BodyModel body;
  MotorModel motors;
  AutopilotOptions autopilot;
};
void describe(core::OptionTable& t, SimulatorOptions& o);

}  // namespace karst::sim
