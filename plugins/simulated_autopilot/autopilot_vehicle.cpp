#include "plugins/simulated_autopilot/autopilot_vehicle.h"

namespace karst::sim {
namespace {

AutopilotBody body_of(const SimulatorOptions& o) {
  const double max_thrust_n = 4 * max_motor_thrust_n(o.motors, o.body);
  return {o.body.weight_n() / max_thrust_n, max_thrust_n};
}

}  // namespace

AutopilotVehicleOptions::AutopilotVehicleOptions() { mavlink.hover_thrust = body_of(simulator).hover_thrust; }

void describe(core::OptionTable& t, AutopilotVehicleOptions& o) {
  describe(t, o.autopilot);
  describe(t, o.link);
  t.section("mavlink", o.mavlink);
  t.section("simulator", o.simulator);
}

/// The simulator's scans, as those of the vehicle's own LiDAR.
class AutopilotVehicle::Scans final : public mavlink::ScanSource {
 public:
  explicit Scans(std::shared_ptr<const core::LidarModel> model) : model_(std::move(model)) {}
  std::shared_ptr<const core::LidarModel> model() const override { return model_; }
  void start(core::Executive&, Receiver receive) override { receive_ = std::move(receive); }
  void pass(std::shared_ptr<const core::LidarScan> scan) const { receive_(std::move(scan)); }

 private:
  std::shared_ptr<const core::LidarModel> model_;
  Receiver receive_;
};

/// The simulated sensors: the autopilot's own go to it, the others to the core.
class AutopilotVehicle::Sensors final : public core::VehicleSink {
 public:
  Sensors(AutopilotVehicle& vehicle, core::VehicleSink& core) : vehicle_(vehicle), core_(core) {}

  void on_imu(const core::ImuSample& s) override {
    core::Command command;
    command.rates = vehicle_.autopilot_.step(s);
    vehicle_.simulated_.command(command);
  }
  void on_magnetometer(const core::MagnetometerSample& s) override { vehicle_.autopilot_.on_magnetometer(s); }
  void on_barometer(const core::BarometerSample& s) override { vehicle_.autopilot_.on_barometer(s); }
  void on_battery(const core::BatteryStatus& s) override { vehicle_.autopilot_.on_battery(s); }
  void on_ground(core::TimeNs) override { vehicle_.autopilot_.on_ground(true); }
  void on_lift_off(core::TimeNs) override { vehicle_.autopilot_.on_ground(false); }

  void on_lidar(std::shared_ptr<const core::LidarScan> s) override { vehicle_.scans_->pass(std::move(s)); }
  void on_depth(std::shared_ptr<const core::DepthImage> image) override {
    hold(image->stamp, [this, image] { core_.on_depth(image); });
  }
  void on_rgb(const std::shared_ptr<const core::RgbFrame>& frame) override {
    hold(frame->stamp, [this, frame] { core_.on_rgb(frame); });
  }
  void on_objects(const core::ObjectDetections& found) override {
    hold(found.stamp, [this, found] { core_.on_objects(found); });
  }
  void on_pose(const core::PoseSample& s) override {
    hold(s.stamp, [this, s] { core_.on_pose(s); });
  }
  void on_lost(core::TimeNs stamp, core::MissionOutcome outcome, const std::string& reason) override {
    core_.on_lost(stamp, outcome, reason);
  }

 private:
  void hold(core::TimeNs stamp, std::function<void()> deliver) {
    vehicle_.mavlink_->hold(stamp, std::move(deliver));
  }

  AutopilotVehicle& vehicle_;
  core::VehicleSink& core_;
};

AutopilotVehicle::AutopilotVehicle(const AutopilotVehicleOptions& o, const core::VehicleSetup& setup)
    : simulated_(o.simulator, setup),
      link_(o.link, setup.seed, [this] { return executive_->now(); }),
      autopilot_(o.autopilot, body_of(o.simulator), link_.open(SimulatedLink::End::autopilot)) {
  assemble(o, setup);
}

AutopilotVehicle::AutopilotVehicle(const AutopilotVehicleOptions& o, const core::VehicleSetup& setup,
                                   const cave::Cave& cave)
    : simulated_(o.simulator, setup, cave),
      link_(o.link, setup.seed, [this] { return executive_->now(); }),
      autopilot_(o.autopilot, body_of(o.simulator), link_.open(SimulatedLink::End::autopilot)) {
  assemble(o, setup);
}

AutopilotVehicle::~AutopilotVehicle() = default;

void AutopilotVehicle::assemble(const AutopilotVehicleOptions& o, const core::VehicleSetup& setup) {
  mavlink::MavlinkOptions mavlink = o.mavlink;
  mavlink.firmware = o.autopilot.firmware;
  mavlink.battery_wh = o.simulator.battery.hover_power_w * o.simulator.battery.minutes / 60;
  auto scans = std::make_unique<Scans>(simulated_.description().lidar);
  scans_ = scans.get();
  mavlink_ = std::make_unique<mavlink::MavlinkVehicle>(
      mavlink, mavlink::MavlinkVehicle::Parts{simulated_.description(), link_.open(SimulatedLink::End::core),
                                              std::move(scans), setup.climb_m, setup.run_dir});
}

void AutopilotVehicle::start(core::Executive& executive, core::VehicleSink& sink) {
  executive_ = &executive;
  sensors_ = std::make_unique<Sensors>(*this, sink);
  simulated_.start(executive, *sensors_);
  mavlink_->start(executive, sink);
}

void AutopilotVehicle::lose_link_for(double s) {
  link_.lose_until(executive_->now() + core::from_seconds(s));
}

void AutopilotVehicle::finish() {
  simulated_.finish();
  mavlink_->finish();
}

}  // namespace karst::sim
