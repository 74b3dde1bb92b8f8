// A vehicle that stands, and is then turned by hand, in a cave: the simulator's sensors along a given motion,
// with one fault planted. For tests of the preflight; it cannot fly.
#pragma once
#include <memory>

#include "core_stack/vehicle/vehicle.h"
#include "plugins/simulator/cameras/depth_camera.h"
#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/environment/launch_site.h"
#include "plugins/simulator/sensors/barometer.h"
#include "plugins/simulator/sensors/imu.h"
#include "plugins/simulator/sensors/lidar.h"
#include "plugins/simulator/sensors/magnetometer.h"
#include "tests/carried_vehicle/hand_motion.h"
#include "tests/carried_vehicle/planted_fault.h"

namespace karst::test {

struct CarriedOptions {
  double lifted_after_s = 15;
  PlantedFault fault = PlantedFault::none;
};
void describe(core::OptionTable& t, CarriedOptions& o);

class CarriedVehicle final : public core::Vehicle {
 public:
  CarriedVehicle(const CarriedOptions& options, const core::VehicleSetup& setup);
  core::VehicleDescription description() const override { return description_; }
  void start(core::Executive& executive, core::VehicleSink& sink) override;
  void command(const core::Command&) override { commanded_ = true; }
  std::vector<core::VehicleCheck> checks() const override;
  bool commanded() const { return commanded_; }

 private:
  void tick();
  void sense_imu();
  void fire_lidar();
  void deliver(core::LidarScan scan);
  /// Sends what the autopilot measures: at once, or late if its link is slow.
  void by_link(std::function<void()> send);
  bool has(PlantedFault fault) const { return options_.fault == fault; }
  core::TimeNs now() const { return executive_->now(); }
  core::Random random_at(const char* purpose) const;

  CarriedOptions options_;
  std::uint64_t seed_;
  cave::Cave cave_;
  sim::LaunchSite site_;
  HandMotion motion_;
  sim::Lidar lidar_;
  sim::DepthCamera camera_;
  sim::Imu imu_;
  core::Random magnetometer_random_;
  sim::Barometer barometer_;
  std::shared_ptr<const core::LidarModel> claimed_;  // what the description says of the LiDAR
  core::VehicleDescription description_;
  core::Executive* executive_ = nullptr;
  core::VehicleSink* sink_ = nullptr;
  sim::PoseTrack track_;
  bool commanded_ = false;
};

}  // namespace karst::test
