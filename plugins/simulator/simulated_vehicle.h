// The simulator as the core stack sees it: a vehicle that delivers sensor messages and takes commands.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/vehicle/vehicle.h"
#include "plugins/simulator/cameras/object_detector.h"
#include "plugins/simulator/dynamics/quadrotor.h"
#include "plugins/simulator/environment/launch_site.h"
#include "plugins/simulator/environment/loose_rocks.h"
#include "plugins/simulator/sensors/sensor_faults.h"
#include "plugins/simulator/simulator_options.h"
#include "plugins/simulator/truth_log.h"

namespace karst::sim {

class SimulatedVehicle final : public core::Vehicle {
 public:
  /// Throws InputError on a bad cave or start pose.
  SimulatedVehicle(const SimulatorOptions& options, const core::VehicleSetup& setup);
  /// The same in a cave that is loaded already, with all its objects, whose clock is `cave_ahead_s` ahead of
  /// the vehicle's own.
  SimulatedVehicle(const SimulatorOptions& options, const core::VehicleSetup& setup, const cave::Cave& cave,
                   double cave_ahead_s = 0);

  core::VehicleDescription description() const override { return description_; }
  void start(core::Executive& executive, core::VehicleSink& sink) override;
  void command(const core::Command& c) override;
  void finish() override;

  // For flights of several vehicles; to be called between two steps of the executive.
  const core::Vec3& position() const { return quadrotor_.state().T_world_body.position; }
  const core::Vec3& velocity_mps() const { return quadrotor_.state().velocity_mps; }
  bool airborne() const { return quadrotor_.footing() != Footing::standing && !lost_; }
  /// Sets the other vehicles that its sensors see from now on. Contact with them is not checked here.
  void see(std::vector<cave::Sphere> others);
  /// Ends its flight: `outcome` is contact if it touched another vehicle, otherwise lost.
  void end_flight(core::MissionOutcome outcome, const std::string& reason) { lose(outcome, reason); }

 private:
  /// A periodic reading; both times are whole ticks.
  struct Reading {
    core::TimeNs period, phase;
    std::function<void()> read;
  };

  void schedule_sensors();
  void tick();
  void take_over();
  void react(QuadrotorEvent event);
  void lose(core::MissionOutcome outcome, const std::string& reason);
  void fire_lidar();
  void fire_camera(std::size_t index);
  void take_picture();
  void look_for_objects(const std::shared_ptr<const core::CameraModel>& camera, Light light);
  void report_pose();
  void move_rocks();
  void stir_air();
  void renew_sight();
  double cave_time_s() const { return core::seconds(now() - start_time_) + cave_ahead_s_; }
  /// The clouds around the sensor now; `beams` names the random stream of their echoes.
  Air air_for(const std::string& beams);
  SensorFaults::InjectedFaults faults_of(cave::Fault::Sensor sensor);
  void log_truth();
  core::TimeNs now() const { return executive_->now(); }
  /// A separate random stream for each measurement, so that results do not depend on thread or order.
  core::Random measurement_random(const std::string& sensor);

  SimulatorOptions options_;
  std::uint64_t seed_;
  double cave_ahead_s_;
  std::shared_ptr<cave::Cave> cave_;        // replaced as a whole when boulders come or move
  std::vector<cave::Sphere> others_;        // other vehicles
  std::shared_ptr<const cave::Cave> seen_;  // the cave with `others_` in it
  LooseRocks rocks_;
  CaveAir air_;
  SensorFaults faults_;
  LaunchSite site_;
  Quadrotor quadrotor_;
  std::shared_ptr<const Lidar> lidar_;
  std::vector<std::shared_ptr<const DepthCamera>> cameras_;
  std::shared_ptr<const RgbCamera> rgb_;
  ObjectDetector detector_;
  std::vector<int> looks_;  // for each object of the cave, the number of images with it in view
  Imu imu_;
  core::Random magnetometer_random_;
  Barometer barometer_;
  PoseSensor pose_sensor_;
  TruthLog log_;
  core::VehicleDescription description_;

  core::Executive* executive_ = nullptr;
  core::VehicleSink* sink_ = nullptr;
  core::TimeNs start_time_ = 0;
  std::vector<Reading> schedule_;
  bool lost_ = false;
  core::TimeNs commanded_at_ = 0;
  std::optional<core::Vec3> velocity_error_mps_;  // of the estimate in the last command; none: it had none
  bool taken_over_ = false;                       // by its autopilot, as no more commands came
  PoseTrack track_;                               // of the last sweep
  core::Vec3 last_velocity_mps_ = core::Vec3::Zero();
  core::Quat last_orientation_ = core::Quat::Identity();
};

}  // namespace karst::sim
