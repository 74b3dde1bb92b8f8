// `karst preflight --vehicle NAME`: listens to a real vehicle before its props turn.
#pragma once
#include <string>
#include <vector>

#include "sdk/flight/mission_file.h"

namespace karst::tools {

struct VehiclePreflightArguments {
  std::string mission_file;  // "": the defaults of a mission
  flight::MissionOverrides overrides;
  std::vector<std::string> plugins;  // policy plugin files that are searched first
  double rest_s = 15, motion_s = 25;
  bool motion = false, real_time = false;
  std::string run_folder = "runs";  // where the flight will be recorded
  std::string page;                 // file to write; "" for none
  bool json = false, quiet = false;
};

/// Whether there is a vehicle plugin of this name.
bool is_vehicle(const std::string& name);

/// Returns whether it is go. Throws core::InputError if the vehicle cannot be opened.
bool vehicle_preflight(const VehiclePreflightArguments& args);

}  // namespace karst::tools
