// The rules by which a vehicle's figures are judged. Thresholds and their reasons: docs/preflight.md.
#pragma once
#include <string>
#include <vector>

#include "sdk/preflight/vehicle/measurements.h"

namespace karst::preflight {

enum class Outcome { pass, watch, no_go };
constexpr auto names_of(Outcome) {
  using enum Outcome;
  return std::to_array<core::Named<Outcome>>({{pass, "pass"}, {watch, "watch"}, {no_go, "no_go"}});
}

enum class Part {
  vehicle,
  imu,
  lidar,
  camera,
  pose,
  compass,
  barometer,
  battery,
  link,
  pad,
  machine,
  policy
};
constexpr auto names_of(Part) {
  using enum Part;
  return std::to_array<core::Named<Part>>({{vehicle, "vehicle"},
                                           {imu, "IMU"},
                                           {lidar, "LiDAR"},
                                           {camera, "camera"},
                                           {pose, "pose sensor"},
                                           {compass, "compass"},
                                           {barometer, "barometer"},
                                           {battery, "battery"},
                                           {link, "link"},
                                           {pad, "pad"},
                                           {machine, "machine"},
                                           {policy, "policy"}});
}

/// One thing that was checked.
struct Check {
  Part part = Part::vehicle;
  std::string what;      // "rate", or the name of an autopilot's parameter
  std::string measured;  // with its unit
  std::string required;
  Outcome outcome = Outcome::pass;
  std::string remedy;  // what to do; "" if it passed
};

/// Everything that was checked, part by part.
std::vector<Check> checks_of(const VehicleMeasurements& m);

/// The worst outcome.
Outcome verdict_of(const std::vector<Check>& checks);

/// What only a person can check before this vehicle flies.
std::vector<std::string> boxes_for_persons(const VehicleMeasurements& m);

}  // namespace karst::preflight
