#include "plugins/simulated_autopilot/autopilot_vehicle.h"

namespace {

class SimulatedAutopilotPlugin final : public karst::core::VehiclePlugin {
 public:
  void describe_options(karst::core::OptionTable& table) override {
    options_ = {};  // drops the options of a mission read before
    describe(table, options_);
  }
  std::unique_ptr<karst::core::Vehicle> create(const karst::core::VehicleSetup& setup) override {
    return std::make_unique<karst::sim::AutopilotVehicle>(options_, setup);
  }

 private:
  karst::sim::AutopilotVehicleOptions options_;
};

}  // namespace

KARST_VEHICLE_PLUGIN(SimulatedAutopilotPlugin)
