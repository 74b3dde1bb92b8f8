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

std::string refusal_of_region(const Prism& keep_in, const std::vector<Prism>& keep_out = {}) {
  FlightRegion::Limits limits;
  limits.keep_in = keep_in;
  limits.keep_out = keep_out;
  limits.margin_m = 0.5;
  CoreOptions o;
  o.region = std::make_shared<const FlightRegion>(limits);
  VehicleDescription vehicle;
  vehicle.radius_m = 0.3;
  vehicle.T_world_start.position = Vec3(2, 3, 1);
  try {
    check_region("some.mission", o, vehicle);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// 0.1 m was taken: the vehicle took off, and could fly nowhere.
TEST(OptionsCheck, ALimitOfTheWayHomeMustLeaveRoomToFly) {
  const auto refusal_of = [](double max_home_m) -> std::string {
    FlightRegion::Limits limits;
    limits.max_home_m = max_home_m;
    CoreOptions o;
    o.mission.takeoff_height_m = 0.7;
    o.planning.clearance_m = 0.6;
    o.region = std::make_shared<const FlightRegion>(limits);
    try {
      check_region("some.mission", o, {});
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refusal_of(1.31), "");
  EXPECT_EQ(refusal_of(60), "");
  for (const double bad_m : {0.1, 0.7, 1.29})
    EXPECT_TRUE(refusal_of(bad_m).starts_with("some.mission: region.max_home_distance: is ")) << bad_m;
  EXPECT_NE(refusal_of(0.1).find("at least 1.30 m"), std::string::npos) << refusal_of(0.1);
}

TEST(OptionsCheck, ARegionMustHoldTheStartTheTakeOffAndTheFirstHover) {
  // The hover is 0.7 m up, and needs clearance, margin and nearly a cell on all sides: 1.28 m.
  EXPECT_EQ(refusal_of_region(box({0, 0, 0.4}, {9, 9, 3})), "");
  for (const auto& [region, what] :
       {std::pair{box({1.8, 0, 0}, {9, 9, 9}),
                  "the vehicle's start at (2.00, 3.00, 1.00): 0.20 m from its border"},
        std::pair{box({2.5, 0, 0}, {9, 9, 9}), "0.50 m from its border and outside, where 0.30 m are needed"},
        std::pair{box({0, 0, 0}, {9, 9, 1.5}), "the take-off"},
        std::pair{box({0, 0, 0}, {9, 9, 2.9}), "the first hover"},
        std::pair{box({0.9, 0, 0}, {9, 9, 9}), "the first hover"},
        std::pair{box({0, 0, 0.5}, {9, 9, 9}), "the first hover"}}) {
    const std::string why = refusal_of_region(region);
    EXPECT_TRUE(why.starts_with("some.mission: region.keep_in: leaves no room for ")) << why;
    EXPECT_NE(why.find(what), std::string::npos) << why;
  }
  const Prism wide = box({-9, -9, -9}, {9, 9, 9});
  EXPECT_EQ(refusal_of_region(wide, {box({2, 3, 5}, {3, 4, 6}), box({4, 4, 1}, {5, 5, 2})}), "");
  const std::string why = refusal_of_region(wide, {box({4, 4, 1}, {5, 5, 2}), box({2, 3, 1.5}, {3, 4, 1.6})});
  EXPECT_NE(why.find("number 2 of region.keep_out: leaves no room for the take-off"), std::string::npos)
      << why;
}

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
