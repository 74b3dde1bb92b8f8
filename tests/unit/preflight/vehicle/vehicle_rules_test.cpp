#include "sdk/preflight/vehicle/vehicle_rules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/unit/preflight/vehicle/degree.h"
#include "tests/unit/preflight/vehicle/known_vehicle.h"

namespace karst::preflight {
namespace {

using Change = std::function<void(VehicleMeasurements&)>;

using test::kDegree;

std::vector<Check> wrong_with(const Change& change) {
  VehicleMeasurements m = test::known_vehicle();
  change(m);
  std::vector<Check> wrong;
  for (const Check& c : checks_of(m))
    if (c.outcome != Outcome::pass) wrong.push_back(c);
  return wrong;
}

/// That this is the one thing that is found, and that it says what to do.
void expect_only(const Change& change, Outcome outcome, Part part, const std::string& what) {
  const std::vector<Check> wrong = wrong_with(change);
  ASSERT_EQ(wrong.size(), 1u) << what;
  EXPECT_EQ(wrong[0].outcome, outcome) << wrong[0].what << ": " << wrong[0].measured;
  EXPECT_EQ(wrong[0].part, part);
  EXPECT_EQ(wrong[0].what, what);
  EXPECT_FALSE(wrong[0].measured.empty());
  EXPECT_FALSE(wrong[0].required.empty());
  EXPECT_FALSE(wrong[0].remedy.empty());
}

/// The timeline of the first sensor of this kind.
Timeline& timeline(VehicleMeasurements& m, Sensor sensor) {
  for (SensorTimeline& s : m.sensors)
    if (s.sensor == sensor) return s.timeline;
  throw std::logic_error("no such sensor");
}

TEST(VehicleRules, NothingSpeaksAgainstAKnownVehicle) {
  EXPECT_TRUE(wrong_with([](VehicleMeasurements&) {}).empty());
  EXPECT_EQ(verdict_of(checks_of(test::known_vehicle())), Outcome::pass);
  EXPECT_EQ(verdict_of({}), Outcome::pass);
}

TEST(VehicleRules, TheVerdictIsTheWorstOutcome) {
  EXPECT_EQ(verdict_of({test::check_with(Outcome::watch), test::check_with(Outcome::pass)}), Outcome::watch);
  EXPECT_EQ(verdict_of({test::check_with(Outcome::no_go), test::check_with(Outcome::watch)}), Outcome::no_go);
}

TEST(VehicleRules, SensorsThatAreSilent) {
  const auto silence = [](Sensor s) { return [s](VehicleMeasurements& m) { timeline(m, s) = {}; }; };
  expect_only(silence(Sensor::imu), Outcome::no_go, Part::imu, "messages");
  expect_only(silence(Sensor::lidar), Outcome::no_go, Part::lidar, "messages");
  expect_only(silence(Sensor::camera), Outcome::no_go, Part::camera, "messages (up)");
  expect_only(silence(Sensor::magnetometer), Outcome::watch, Part::compass, "messages");
  expect_only(silence(Sensor::barometer), Outcome::watch, Part::barometer, "messages");
  expect_only(silence(Sensor::battery), Outcome::no_go, Part::battery, "messages");
}

TEST(VehicleRules, RatesAndGaps) {
  const auto rate = [](Sensor s, double hz) {
    return [=](VehicleMeasurements& m) { timeline(m, s).rate_hz = hz; };
  };
  expect_only(rate(Sensor::imu, 100), Outcome::watch, Part::imu, "rate");
  expect_only(rate(Sensor::imu, 50), Outcome::no_go, Part::imu, "rate");
  expect_only(rate(Sensor::lidar, 5), Outcome::no_go, Part::lidar, "rate");
  expect_only(rate(Sensor::lidar, 8.5), Outcome::watch, Part::lidar, "rate");
  expect_only([](auto& m) { timeline(m, Sensor::imu).longest_gap_s = 0.3; }, Outcome::no_go, Part::imu,
              "longest gap");
  expect_only([](auto& m) { timeline(m, Sensor::lidar).longest_gap_s = 0.6; }, Outcome::watch, Part::lidar,
              "longest gap");
}

TEST(VehicleRules, Stamps) {
  const auto with = [](double Timeline::*field, double value) {
    return [=](VehicleMeasurements& m) { timeline(m, Sensor::lidar).*field = value; };
  };
  expect_only(with(&Timeline::future_s, 0.1), Outcome::no_go, Part::lidar, "stamps in the future");
  expect_only(with(&Timeline::jump_s, -0.4), Outcome::no_go, Part::lidar, "steadiness of the clock");
  expect_only(with(&Timeline::jitter_s, 0.06), Outcome::watch, Part::lidar, "regularity of stamps");
  expect_only(with(&Timeline::latency_s, 0.3), Outcome::no_go, Part::lidar, "latency");
  expect_only([](auto& m) { timeline(m, Sensor::lidar).backward = 1; }, Outcome::no_go, Part::lidar,
              "order of stamps");
  expect_only([](auto& m) { timeline(m, Sensor::imu).latency_s = 0.3; }, Outcome::no_go, Part::link,
              "latency of the IMU's messages");
}

TEST(VehicleRules, TheImuAtRest) {
  expect_only([](auto& m) { m.imu.mean_force_mps2 *= 1.05; }, Outcome::no_go, Part::imu, "length of gravity");
  expect_only(
      [](auto& m) {
        m.imu.mean_force_mps2 = {0, 0, -9.81};
      },
      Outcome::no_go, Part::imu, "direction of gravity");
  expect_only(
      [](auto& m) {
        m.imu.mean_force_mps2 = {9.81 * std::sin(15 * kDegree), 0, 9.81 * std::cos(15 * kDegree)};
      },
      Outcome::watch, Part::imu, "direction of gravity");
  expect_only([](auto& m) { m.imu.mean_rate_radps.y() = 0.12; }, Outcome::no_go, Part::imu,
              "bias of the gyroscope");
  expect_only([](auto& m) { m.imu.rate_noise_radps = 0.03; }, Outcome::watch, Part::imu,
              "noise of the gyroscope");
  expect_only([](auto& m) { m.imu.rate_noise_radps = 0.3; }, Outcome::no_go, Part::imu, "standing still");
  expect_only([](auto& m) { m.imu.invalid = 1; }, Outcome::no_go, Part::imu, "values that are no numbers");
  expect_only([](auto& m) { m.imu.repeated = 0.5; }, Outcome::no_go, Part::imu, "repeated samples");
  expect_only([](auto& m) { m.motion->clipped = 0.05; }, Outcome::watch, Part::imu,
              "samples at the limit of its range");
}

TEST(VehicleRules, TheMountingOfTheLidar) {
  const auto turned = [](double degrees, double sigma_deg = 0.05) {
    return [=](VehicleMeasurements& m) {
      m.motion->hand_eye->error_rad = {0, degrees * kDegree, 0};
      m.motion->hand_eye->sigma_rad = sigma_deg * kDegree;
    };
  };
  EXPECT_TRUE(wrong_with(turned(0.9)).empty());
  expect_only(turned(1.2), Outcome::watch, Part::lidar, "rotation of the mounting");
  expect_only(turned(1.6), Outcome::no_go, Part::lidar, "rotation of the mounting");
  expect_only(turned(1.6, 1.0), Outcome::watch, Part::lidar, "rotation of the mounting");
  expect_only(turned(0.1, 0.7), Outcome::watch, Part::lidar, "rotation of the mounting");
}

TEST(VehicleRules, WhatTheMotionShows) {
  expect_only([](auto& m) { m.motion->hand_eye->delay_s = 0.2; }, Outcome::no_go, Part::lidar,
              "delay of its stamps behind the IMU's");
  expect_only([](auto& m) { m.motion->hand_eye->delay_s = -0.03; }, Outcome::watch, Part::lidar,
              "delay of its stamps behind the IMU's");
  expect_only([](auto& m) { m.motion->hand_eye->scale = 1 / 1.2; }, Outcome::no_go, Part::imu,
              "scale of the gyroscope");
  expect_only([](auto& m) { m.motion->hand_eye->explained = 0.5; }, Outcome::no_go, Part::lidar,
              "turns agree with the gyroscope's");
  expect_only([](auto& m) { m.motion->hand_eye->weakest_rate_radps = 0.01; }, Outcome::watch, Part::lidar,
              "turned about all axes");
  expect_only([](auto& m) { m.motion->matched = 150; }, Outcome::watch, Part::lidar,
              "scans that can be matched");
  expect_only([](auto& m) { m.motion->hand_eye.reset(); }, Outcome::no_go, Part::lidar, "mounting and delay");
  expect_only([](auto& m) { m.motion.reset(); }, Outcome::watch, Part::lidar, "mounting and delay");
}

// Its stamps were blamed: the delay and the agreement of noise with noise.
TEST(VehicleRules, AVehicleThatWasNotTurnedIsNotBlamedForItsStamps) {
  const auto stood = [](VehicleMeasurements& m) {
    m.motion->gyroscope_rates =
        m.motion->lidar_rates = {{0, 0.002}, {core::kSecond, 0.01}, {2 * core::kSecond, 0.004}};
    m.motion->lidar_rates.push_back({3 * core::kSecond, 9});  // a scan was matched wrongly
    m.motion->hand_eye->explained = 0.01;
    m.motion->hand_eye->delay_s = -0.43;
    m.motion->hand_eye->weakest_rate_radps = 0.001;
    m.compass->by_gyroscope->scatter_as_is = m.compass->by_lidar->scatter_as_is = 10;
  };
  expect_only(stood, Outcome::no_go, Part::lidar, "turned by hand");
  EXPECT_NE(wrong_with(stood)[0].remedy.find("roll it, nod it and turn it"), std::string::npos);
  // A gyroscope that is dead while the LiDAR turns is another fault.
  const auto dead = [](VehicleMeasurements& m) {
    for (TurnRate& r : m.motion->gyroscope_rates) r.radps = 0;
    m.motion->hand_eye->explained = 0;
  };
  expect_only(dead, Outcome::no_go, Part::lidar, "turns agree with the gyroscope's");
}

Eigen::Matrix3d quarter_turn() {
  return Eigen::AngleAxisd(90 * kDegree, core::Vec3::UnitZ()).toRotationMatrix();
}

AxisTest turned_axes(double strength) {
  AxisTest t;
  t.best = nearest_axis_map(quarter_turn());
  t.scatter = 0.02 * strength;
  t.scatter_as_is = 0.5 * strength;
  t.strength = strength;
  t.samples = 1000;
  return t;
}

TEST(VehicleRules, AxesThatAreTurned) {
  expect_only([](auto& m) { m.motion->hand_eye->map = quarter_turn(); }, Outcome::no_go, Part::lidar,
              "axes of LiDAR and IMU");
  expect_only([](auto& m) { m.compass->by_gyroscope = m.compass->by_lidar = turned_axes(49); },
              Outcome::no_go, Part::compass, "axes, by turning");
  // The gyroscope is wrong by gravity: neither the LiDAR nor the compass is to blame.
  expect_only(
      [](auto& m) {
        m.motion->gyroscope_axes = turned_axes(9.81);
        m.motion->hand_eye->map = quarter_turn();
        m.compass->by_gyroscope = turned_axes(49);
      },
      Outcome::no_go, Part::imu, "axes of the gyroscope, by gravity");
  // The LiDAR is turned: the compass agrees with the gyroscope.
  expect_only(
      [](auto& m) {
        m.motion->hand_eye->map = quarter_turn();
        m.compass->by_lidar = turned_axes(49);
      },
      Outcome::no_go, Part::lidar, "axes of LiDAR and IMU");
}

TEST(VehicleRules, TheCompass) {
  expect_only([](auto& m) { m.compass->strength_ut = 90; }, Outcome::watch, Part::compass, "field strength");
  expect_only([](auto& m) { m.compass->dip_rad = 1.55; }, Outcome::watch, Part::compass, "horizontal part");
  expect_only([](auto& m) { m.compass->strength_spread = 0.2; }, Outcome::watch, Part::compass,
              "strength while turned");
  expect_only(
      [](auto& m) { m.compass->by_lidar->scatter_as_is = m.compass->by_gyroscope->scatter_as_is = 10; },
      Outcome::watch, Part::compass, "direction while turned");
}

TEST(VehicleRules, TheViewOfTheLidar) {
  expect_only(
      [](auto& m) {
        m.lidar->blocked = {0.5, 40 * kDegree, false};
      },
      Outcome::no_go, Part::lidar, "blocked sector");
  expect_only(
      [](auto& m) {
        m.lidar->blocked = {0.5, 10 * kDegree, true};
      },
      Outcome::watch, Part::lidar, "blocked sector");
  expect_only([](auto& m) { m.lidar->noise_m = 0.1; }, Outcome::watch, Part::lidar, "noise of ranges");
  expect_only([](auto& m) { m.lidar->flicker = 0.5; }, Outcome::watch, Part::lidar, "beams that come and go");
  expect_only([](auto& m) { m.lidar->intensity = 0.001; }, Outcome::watch, Part::lidar,
              "intensity of returns");
  expect_only([](auto& m) { m.lidar->misshapen = 3; }, Outcome::no_go, Part::lidar, "size of scans");
}

TEST(VehicleRules, TheRoomAroundThePad) {
  expect_only([](auto& m) { m.room.above_m = 1.1; }, Outcome::no_go, Part::pad, "room above");
  expect_only([](auto& m) { m.room.around_m = 0.2; }, Outcome::watch, Part::pad, "room around");
  expect_only([](auto& m) { m.room.around_m = 0.05; }, Outcome::no_go, Part::pad, "room around");
  expect_only([](auto& m) { m.room.known = false; }, Outcome::no_go, Part::pad, "room");
}

TEST(VehicleRules, BatteryBarometerMachinePolicyAndAutopilot) {
  expect_only([](auto& m) { m.battery->fraction_left = 0.7; }, Outcome::watch, Part::battery, "charge");
  expect_only([](auto& m) { m.battery->fraction_left = 0.3; }, Outcome::no_go, Part::battery, "charge");
  expect_only([](auto& m) { m.battery->fraction_left = NAN; }, Outcome::no_go, Part::battery, "charge");
  expect_only([](auto& m) { m.battery->seconds_left = 50; }, Outcome::no_go, Part::battery, "time left");
  expect_only([](auto& m) { m.barometer->frozen = true; }, Outcome::watch, Part::barometer, "noise at rest");
  expect_only([](auto& m) { m.barometer->drift_m = -2; }, Outcome::watch, Part::barometer, "drift at rest");
  expect_only([](auto& m) { m.machine.free_bytes = 100u << 20; }, Outcome::no_go, Part::machine,
              "free space for runs");
  expect_only([](auto& m) { m.machine.free_bytes.reset(); }, Outcome::no_go, Part::machine,
              "free space for runs");
  // Scans of an hour at 3.6 MB/s need 12 GiB more.
  const double scans = 3600 * 3.6e6;
  const auto free = [scans](double gib) {
    return [=](auto& m) {
      m.machine.scans_bytes = scans;
      m.machine.free_bytes = static_cast<std::uintmax_t>(gib * (1 << 30));
    };
  };
  EXPECT_TRUE(wrong_with(free(16.5)).empty());
  expect_only(free(15.5), Outcome::watch, Part::machine, "free space for runs");
  expect_only(free(12.5), Outcome::no_go, Part::machine, "free space for runs");
  expect_only([](auto& m) { m.machine.clock_plausible = false; }, Outcome::watch, Part::machine, "date");
  expect_only([](auto& m) { m.machine.policy_problem = "no such policy"; }, Outcome::no_go, Part::policy,
              "loads: nearest_frontier");
  expect_only([](auto& m) { m.checks[0].holds = false; }, Outcome::no_go, Part::link, "COM_OF_LOSS_T");
  expect_only([](auto& m) { m.lost = "the link is down"; }, Outcome::no_go, Part::vehicle, "stays");
  expect_only([](auto& m) { m.lifted_off = true; }, Outcome::no_go, Part::vehicle, "stands");
}

TEST(VehicleRules, AskPersonsForWhatNoSensorSees) {
  VehicleMeasurements m = test::known_vehicle();
  const std::size_t seen = boxes_for_persons(m).size();
  m.room.seen_above = false;
  EXPECT_EQ(boxes_for_persons(m).size(), seen + 1);
}

}  // namespace
}  // namespace karst::preflight
