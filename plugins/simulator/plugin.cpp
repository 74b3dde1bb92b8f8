#include "plugins/simulator/simulated_team.h"

namespace {

class SimulatorPlugin final : public karst::sim::SimulatedWorldPlugin {
 public:
  void describe_options(karst::core::OptionTable& table) override {
    options_ = {};  // drops the options of a mission read before
    describe(table, options_);
  }
  std::unique_ptr<karst::core::Vehicle> create(const karst::core::VehicleSetup& setup) override {
    return std::make_unique<karst::sim::SimulatedVehicle>(options_, setup);
  }
  void describe_radio(karst::core::OptionTable& table) override {
    radio_ = {};
    describe(table, radio_);
  }
  std::unique_ptr<karst::sim::SimulatedWorld> create_world(const karst::sim::WorldSetup& setup) override {
    return std::make_unique<karst::sim::SimulatedTeam>(options_, radio_, setup);
  }

 private:
  karst::sim::SimulatorOptions options_;
  karst::sim::RadioOptions radio_;
};

}  // namespace

KARST_VEHICLE_PLUGIN(SimulatorPlugin)
