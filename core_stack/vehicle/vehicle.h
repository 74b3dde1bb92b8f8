// The interface to what carries the core stack: a simulator, a replay, an autopilot.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "core_stack/common/executive.h"
#include "core_stack/common/options.h"
#include "core_stack/vehicle/authority.h"
#include "core_stack/vehicle/command.h"
#include "core_stack/vehicle/mesh_keys.h"
#include "core_stack/vehicle/messages.h"
#include "core_stack/vehicle/mission_outcome.h"
#include "core_stack/vehicle/object_detection.h"
#include "core_stack/vehicle/rgb_camera_model.h"

namespace karst::core {

/// Something that must hold of a vehicle before the core takes off with it, such as a parameter of its
/// autopilot.
struct VehicleCheck {
  std::string name;      // "COM_OF_LOSS_T"
  std::string required;  // "at most 1 s"
  std::string found;     // "5 s"; "" if the vehicle did not answer
  bool holds = false;
};

/// What the core stack must know of a vehicle before it flies.
struct VehicleDescription {
  std::string name;
  double radius_m = 0.3;  // of the sphere that holds the vehicle
  double mass_kg = 2.0;
  double max_thrust_n = 45.0;
  double max_body_rate_radps = 6.0;
  std::shared_ptr<const LidarModel> lidar;  // null: none
  std::vector<std::shared_ptr<const CameraModel>> cameras;
  std::shared_ptr<const RgbCameraModel> rgb;  // null: none
  bool pose_sensor = false;                   // its poses come by themselves
  bool detects_objects = false;               // it looks for objects of interest
  Authority authority = Authority::core;      // who steers it at the start
  bool takes_reference = false;               // it flies Command.reference by controllers of its own
  Pose T_world_start;  // the pose it stands at before take-off, in the mission's world frame
};

/// Where a vehicle delivers its messages. All calls come on the executive's loop thread.
class VehicleSink {
 public:
  virtual ~VehicleSink() = default;
  virtual void on_lidar(std::shared_ptr<const LidarScan>) = 0;
  virtual void on_depth(std::shared_ptr<const DepthImage>) = 0;
  virtual void on_rgb(const std::shared_ptr<const RgbFrame>&) {}
  virtual void on_objects(const ObjectDetections&) {}
  virtual void on_imu(const ImuSample&) = 0;
  virtual void on_magnetometer(const MagnetometerSample&) = 0;
  virtual void on_barometer(const BarometerSample&) {}
  virtual void on_pose(const PoseSample&) = 0;
  virtual void on_battery(const BatteryStatus&) = 0;
  /// The vehicle stands on the ground.
  virtual void on_ground(TimeNs stamp) = 0;
  /// It has left the ground.
  virtual void on_lift_off(TimeNs stamp) = 0;
  /// Another steers the vehicle from now on: the core's commands have an effect only while it is the core. A
  /// vehicle that never says so is steered by whom its description names.
  virtual void on_authority(TimeNs, Authority, const std::string&) {}
  /// What the vehicle measured for a while never came, though the stamps show no gap: the core stood still,
  /// and its clock was set back. The vehicle may be elsewhere.
  virtual void on_gap() {}
  /// Nothing more will come from this vehicle (crash, empty battery, end of a recording).
  virtual void on_lost(TimeNs stamp, MissionOutcome outcome, const std::string& reason) = 0;
};

/// A vehicle that has been given no command for so long steers itself: it brakes, and comes down, as
/// autopilots do. The core may hang, or its process may be gone.
constexpr TimeNs kCommandTimeout = 500 * kMillisecond;

class Vehicle {
 public:
  virtual ~Vehicle() = default;
  virtual VehicleDescription description() const = 0;
  /// Registers the vehicle's periodic work. `sink` outlives the executive's run.
  virtual void start(Executive& executive, VehicleSink& sink) = 0;
  virtual void command(const Command&) = 0;
  /// What must hold before it may fly, with what was found. After `start`, once the vehicle has answered.
  virtual std::vector<VehicleCheck> checks() const { return {}; }
  /// Called once after the run, to close files.
  virtual void finish() {}
};

/// What a vehicle plugin is given to set itself up.
struct VehicleSetup {
  std::string cave;     // cave .info or mesh, "" if the vehicle needs none
  std::string start;    // "x y z [heading_deg]", "" for the cave's own
  std::string run_dir;  // it may write its own files here, such as ground truth; "" for none
  double climb_m = 0;   // by which it will rise from where it stands, before anything is known
  std::uint64_t seed = 1;
  MeshKeys mesh = {};             // of a cave that is a bare mesh
  Clock clock = Clock::lockstep;  // of the executive that it will be started in
};

/// A vehicle plugin's factory. `options()` describes the section of the mission file that bears the
/// plugin's name; `create` throws InputError on bad input.
class VehiclePlugin {
 public:
  virtual ~VehiclePlugin() = default;
  virtual void describe_options(OptionTable& table) = 0;  // rows keep pointing into this object
  virtual std::unique_ptr<Vehicle> create(const VehicleSetup& setup) = 0;
};

}  // namespace karst::core

/// The one symbol a vehicle plugin exports: C++ inside one build, not a promise to outsiders.
using karst_vehicle_plugin_fn = karst::core::VehiclePlugin* (*)();
// NOLINTBEGIN(bugprone-macro-parentheses): a type cannot stand in parentheses
#define KARST_VEHICLE_PLUGIN(Type)                                                                       \
  extern "C" __attribute__((visibility("default"))) karst::core::VehiclePlugin* karst_vehicle_plugin() { \
    static Type plugin;                                                                                  \
    return &plugin;                                                                                      \
  }
// NOLINTEND(bugprone-macro-parentheses)
