// `karst fly` of a mission with a team (docs/homing.md).
#pragma once
#include "sdk/tools/flight_setup.h"

namespace karst::tools {

/// Flies the team into args.run_dir: one sub-folder robot_N a robot, each a run directory of its own, and
/// what is the team's beside them (docs/run_directory.md). Returns the exit code. Throws core::InputError
/// before anything flies; `check` is a file to write the mission as resolved to instead of flying, or "".
int fly_team(const Mission& mission, const FlightArguments& args, const std::string& check);

}  // namespace karst::tools
