// The vehicle `simulated_autopilot`: the simulated quadrotor, flown by a simulated autopilot that the core
// reaches by MAVLink only. LiDAR and cameras are the core's own, as on a real vehicle.
#pragma once
#include "plugins/mavlink/mavlink_vehicle.h"
#include "plugins/simulated_autopilot/autopilot.h"
#include "plugins/simulated_autopilot/simulated_link.h"
#include "plugins/simulator/simulated_vehicle.h"

namespace karst::sim {

struct AutopilotVehicleOptions {
  AutopilotVehicleOptions();
  AutopilotFirmwareOptions autopilot;
  SimulatedLinkOptions link;
  mavlink::MavlinkOptions mavlink;
  SimulatorOptions simulator;
};
void describe(core::OptionTable& t, AutopilotVehicleOptions& o);

class AutopilotVehicle final : public core::Vehicle {
 public:
  /// Throws InputError on a bad cave, start or script.
  AutopilotVehicle(const AutopilotVehicleOptions& options, const core::VehicleSetup& setup);
  AutopilotVehicle(const AutopilotVehicleOptions& options, const core::VehicleSetup& setup,
                   const cave::Cave& cave);
  ~AutopilotVehicle() override;

  core::VehicleDescription description() const override { return mavlink_->description(); }
  void start(core::Executive& executive, core::VehicleSink& sink) override;
  void command(const core::Command& c) override { mavlink_->command(c); }
  std::vector<core::VehicleCheck> checks() const override { return mavlink_->checks(); }
  void finish() override;

  const SimulatedVehicle& simulated() const { return simulated_; }
  const Autopilot& autopilot() const { return autopilot_; }
  const mavlink::MavlinkVehicle& mavlink() const { return *mavlink_; }
  /// The link fails for so long from now on.
  void lose_link_for(double s);
  /// Acts at once, besides the script.
  void pilot(PilotAction action) { autopilot_.pilot(action); }

 private:
  class Scans;
  class Sensors;
  void assemble(const AutopilotVehicleOptions& options, const core::VehicleSetup& setup);

  core::Executive* executive_ = nullptr;
  SimulatedVehicle simulated_;
  SimulatedLink link_;
  Autopilot autopilot_;
  Scans* scans_ = nullptr;  // owned by mavlink_
  std::unique_ptr<mavlink::MavlinkVehicle> mavlink_;
  std::unique_ptr<Sensors> sensors_;
};

}  // namespace karst::sim
