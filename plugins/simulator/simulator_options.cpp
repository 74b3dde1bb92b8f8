#include "plugins/simulator/simulator_options.h"

namespace karst::sim {

void describe(core::OptionTable& t, SimulatorOptions& o) {
  t.add(
      "vehicle", o.vehicle,
      "lidar_uav: LiDAR, depth cameras up and down; lidar_only_uav: no cameras; camera_uav: one depth camera "
      "forward");
  describe(t, o.battery);
  describe(t, o.wind);
  t.section("air", o.air);
  t.section("lidar", o.lidar);
  t.section("camera", o.camera);
  t.section("rgb", o.rgb);
  t.section("objects", o.objects);
  t.section("imu", o.imu);
  t.section("magnetometer", o.magnetometer);
  t.section("barometer", o.barometer);
  t.section("pose", o.pose);
  t.section("body", o.body);
  t.section("motors", o.motors);
  t.section("autopilot", o.autopilot);
}

}  // namespace karst::sim
