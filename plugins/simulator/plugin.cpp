#include "plugins/simulator/simulated_vehicle.h"

namespace {

class SimulatorPlugin final : public karst::core::VehiclePlugin {
 public:
  void describe_options(karst::core::OptionTable& table) override {
    options_ = {};  // nothing of a mission read before
    describe(table, options_);
  }
  std::unique_ptr<karst::core::Vehicle> create(const karst::core::VehicleSetup& setup) override {
    return std::make_unique<karst::sim::SimulatedVehicle>(options_, setup);
  }

 private:
  karst::sim::SimulatorOptions options_;
};

}  // namespace

KARST_VEHICLE_PLUGIN(SimulatorPlugin)
