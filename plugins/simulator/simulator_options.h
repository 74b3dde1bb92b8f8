// Everything that can be set in the mission file's section `simulator`.
#pragma once
#include "plugins/simulator/autopilot.h"
#include "plugins/simulator/barometer.h"
#include "plugins/simulator/battery.h"
#include "plugins/simulator/cave_air.h"
#include "plugins/simulator/depth_camera.h"
#include "plugins/simulator/imu.h"
#include "plugins/simulator/lidar.h"
#include "plugins/simulator/magnetometer.h"
#include "plugins/simulator/motors.h"
#include "plugins/simulator/object_options.h"
#include "plugins/simulator/pose_sensor.h"
#include "plugins/simulator/rgb_camera.h"
#include "plugins/simulator/wind.h"

namespace karst::sim {

struct SimulatorOptions {
  std::string vehicle = "lidar_uav";
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
