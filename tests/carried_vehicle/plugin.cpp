#include "tests/carried_vehicle/carried_vehicle.h"

namespace {

class CarriedPlugin final : public karst::core::VehiclePlugin {
 public:
  void describe_options(karst::core::OptionTable& table) override {
    options_ = {};
    describe(table, options_);
  }
  std::unique_ptr<karst::core::Vehicle> create(const karst::core::VehicleSetup& setup) override {
    return std::make_unique<karst::test::CarriedVehicle>(options_, setup);
  }

 private:
  karst::test::CarriedOptions options_;
};

}  // namespace

KARST_VEHICLE_PLUGIN(CarriedPlugin)
