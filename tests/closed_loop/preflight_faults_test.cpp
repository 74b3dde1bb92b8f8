// A vehicle with a planted fault, through the whole of the preflight: sensors in a cave, motion by hand, scan
// matching, figures and rules. docs/results/preflight_faults.md
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "command.h"
#include "sdk/preflight/vehicle/listen.h"
#include "sdk/preflight/vehicle/vehicle_rules.h"
#include "tests/carried_vehicle/carried_vehicle.h"

namespace karst {
namespace {

using preflight::Check;
using preflight::Outcome;
using preflight::Part;
using test::PlantedFault;

constexpr core::TimeNs kRest = 6 * core::kSecond, kMotion = 18 * core::kSecond;

preflight::VehicleMeasurements measured(const std::string& cave, PlantedFault fault, bool motion,
                                        std::uint64_t seed = 1) {
  core::VehicleSetup setup;
  setup.cave = cave;
  setup.seed = seed;
  test::CarriedVehicle vehicle({.lifted_after_s = core::seconds(kRest), .fault = fault}, setup);
  const std::atomic<bool> interrupted = false;
  const preflight::VehicleRecord record =
      preflight::listen(vehicle, {.rest = kRest, .motion = motion ? kMotion : 0}, interrupted);
  EXPECT_FALSE(vehicle.commanded());
  preflight::VehicleMeasurements m = preflight::measure(record, {});
  m.machine.free_bytes = std::uintmax_t{50} << 30;
  return m;
}

std::vector<Check> wrong_of(const preflight::VehicleMeasurements& m) {
  std::vector<Check> wrong;
  for (const Check& c : preflight::checks_of(m))
    if (c.outcome != Outcome::pass && c.measured != "not measured") wrong.push_back(c);
  return wrong;
}

std::string text_of(const std::vector<Check>& checks) {
  std::string text;
  for (const Check& c : checks)
    text += std::string(core::name_of(c.outcome)) + " " + core::name_of(c.part) + ", " + c.what + ": " +
            c.measured + "\n";
  return text;
}

struct Expected {
  PlantedFault fault;
  bool motion;
  Outcome outcome;
  Part part;
  const char* what;
};
void PrintTo(const Expected& e, std::ostream* out) { *out << core::name_of(e.fault); }

class Planted : public testing::TestWithParam<Expected> {};

TEST_P(Planted, IsFoundAndNamed) {
  const Expected e = GetParam();
  const std::vector<Check> wrong = wrong_of(measured(generated_cave("small", 3), e.fault, e.motion));
  const auto named = std::find_if(wrong.begin(), wrong.end(), [&](const Check& c) {
    return c.part == e.part && c.what == e.what && c.outcome == e.outcome;
  });
  EXPECT_NE(named, wrong.end()) << text_of(wrong);
}

using enum PlantedFault;
INSTANTIATE_TEST_SUITE_P(
    AtRest, Planted,
    testing::Values(Expected{lidar_ahead, false, Outcome::no_go, Part::lidar, "stamps in the future"},
                    Expected{lidar_slow, false, Outcome::no_go, Part::lidar, "rate"},
                    Expected{lidar_covered, false, Outcome::no_go, Part::lidar, "blocked sector"},
                    Expected{lidar_sees_hull, false, Outcome::no_go, Part::lidar, "blocked sector"},
                    Expected{lidar_dirty, false, Outcome::watch, Part::lidar, "noise of ranges"},
                    Expected{lidar_clock_jumps, false, Outcome::no_go, Part::lidar,
                             "steadiness of the clock"},
                    Expected{imu_half_rate, false, Outcome::watch, Part::imu, "rate"},
                    Expected{imu_gap, false, Outcome::no_go, Part::imu, "longest gap"},
                    Expected{imu_upside_down, false, Outcome::no_go, Part::imu, "direction of gravity"},
                    Expected{accelerometer_scaled, false, Outcome::no_go, Part::imu, "length of gravity"},
                    Expected{compass_missing, false, Outcome::watch, Part::compass, "messages"},
                    Expected{barometer_stuck, false, Outcome::watch, Part::barometer, "noise at rest"},
                    Expected{battery_low, false, Outcome::no_go, Part::battery, "charge"},
                    Expected{no_room_above, false, Outcome::no_go, Part::pad, "room above"},
                    Expected{parameter_wrong, false, Outcome::no_go, Part::link, "COM_OF_LOSS_T"},
                    Expected{link_slow, false, Outcome::no_go, Part::link, "latency of the IMU's messages"}));
INSTANTIATE_TEST_SUITE_P(
    InMotion, Planted,
    testing::Values(
        Expected{lidar_rolled, true, Outcome::no_go, Part::lidar, "rotation of the mounting"},
        Expected{lidar_pitched, true, Outcome::no_go, Part::lidar, "rotation of the mounting"},
        Expected{lidar_yawed, true, Outcome::no_go, Part::lidar, "rotation of the mounting"},
        Expected{lidar_right_angle, true, Outcome::no_go, Part::lidar, "axes of LiDAR and IMU"},
        Expected{lidar_late, true, Outcome::no_go, Part::lidar, "delay of its stamps behind the IMU's"},
        Expected{gyro_swapped, true, Outcome::no_go, Part::imu, "axes of the gyroscope, by gravity"},
        Expected{gyro_scaled, true, Outcome::no_go, Part::imu, "scale of the gyroscope"},
        Expected{compass_turned, true, Outcome::no_go, Part::compass, "axes, by turning"}));

TEST(HealthyVehicle, HasNoFinding) {
  for (int seed = 1; seed <= seeds(); ++seed) {
    const preflight::VehicleMeasurements m =
        measured(generated_cave("small", seed == 1 ? 3 : 7), none, true, static_cast<std::uint64_t>(seed));
    EXPECT_EQ(text_of(wrong_of(m)), "");
    ASSERT_TRUE(m.motion && m.motion->hand_eye);
    EXPECT_LT(m.motion->hand_eye->error_rad.norm(), 0.5 * std::numbers::pi / 180);
    EXPECT_NEAR(m.motion->hand_eye->delay_s, 0, 0.01);
  }
}

// What was measured of the mounting is what was planted.
TEST(HealthyVehicle, TheErrorOfTheMountingIsMeasuredInEachAxis) {
  const auto m = measured(generated_cave("small", 3), lidar_pitched, true);
  ASSERT_TRUE(m.motion && m.motion->hand_eye);
  const core::Vec3 found_deg = m.motion->hand_eye->error_rad * 180 / std::numbers::pi;
  EXPECT_NEAR(found_deg.x(), 0, 0.3);
  EXPECT_NEAR(found_deg.y(), 3, 0.3);
  EXPECT_NEAR(found_deg.z(), 0, 0.3);
}

TEST(CarriedVehicle, ThePreflightIsTheSameTwice) {
  const auto once = measured(generated_cave("small", 3), none, true),
             again = measured(generated_cave("small", 3), none, true);
  ASSERT_TRUE(once.motion->hand_eye && again.motion->hand_eye);
  EXPECT_EQ(once.motion->hand_eye->error_rad, again.motion->hand_eye->error_rad);
  EXPECT_EQ(once.imu.mean_force_mps2, again.imu.mean_force_mps2);
}

}  // namespace
}  // namespace karst
