#include <gtest/gtest.h>

#include "core_stack/common/error.h"
#include "core_stack/mission/options/mission_options.h"

namespace karst::core {
namespace {

std::string refusal(const CoreOptions& o, bool pose_sensor = true) {
  VehicleDescription vehicle;
  vehicle.radius_m = 0.3;
  vehicle.pose_sensor = pose_sensor;
  try {
    check(o, vehicle);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(OptionsCheck, TheDefaultsFitTogether) { EXPECT_EQ(refusal({}), ""); }

TEST(OptionsCheck, AVehicleThatCannotLocateItselfIsRefused) {
  EXPECT_NE(refusal({}, false).find("no pose sensor, nor a LiDAR"), std::string::npos) << refusal({}, false);
}

TEST(OptionsCheck, AClearanceBelowTheVehiclesRadiusIsRefused) {
  CoreOptions o;
  o.planning.clearance_m = 0.2;
  EXPECT_NE(refusal(o).find("planning.clearance: 0.200 m is less than the vehicle's radius"),
            std::string::npos)
      << refusal(o);
}

TEST(OptionsCheck, ANarrowMarginThatIsNoLessThanTheClearanceIsRefused) {
  // As it was: it was taken without a word, and no narrow passage was flown.
  CoreOptions o;
  o.planning.narrow_margin_m = 0.29;
  EXPECT_EQ(refusal(o), "");
  o.planning.narrow_margin_m = 0.5;
  EXPECT_NE(refusal(o).find("planning.narrow_margin: with the vehicle's radius it makes 0.800 m"),
            std::string::npos)
      << refusal(o);
}

TEST(OptionsCheck, ANarrowMarginBelowAQuarterOfACellIsRefused) {
  CoreOptions o;
  o.planning.narrow_margin_m = 0.04;
  EXPECT_NE(refusal(o).find("planning.narrow_margin: 0.040 m is less than a quarter of a cell"),
            std::string::npos)
      << refusal(o);
}

TEST(OptionsCheck, AClearanceOfTooManyCellsIsRefusedOnTheGround) {
  // As it was: the first decision threw in flight.
  CoreOptions o;
  o.map.resolution_m = 0.04;
  EXPECT_NE(refusal(o).find("planning.clearance: 0.600 m is more than 14 cells"), std::string::npos)
      << refusal(o);
  o = {};
  o.planning.preferred_clearance_m = 5;
  EXPECT_NE(refusal(o).find("planning.preferred_clearance: 5.000 m is more than 14 cells"), std::string::npos)
      << refusal(o);
}

}  // namespace
}  // namespace karst::core
