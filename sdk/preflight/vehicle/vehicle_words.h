// The checks of a vehicle in words, as the terminal shows them, and as JSON.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sdk/preflight/vehicle/vehicle_rules.h"

namespace karst::preflight {

/// "GO", "GO, with 2 things to watch for", "NO-GO, for 1 reason".
std::string verdict_text(const std::vector<Check>& checks);

/// What passed of a part, in one line: a list of all checks is long.
std::string passed_text(const std::vector<Check>& checks, Part part);

/// What was listened to: "plugin mavlink, mission cave.info".
std::string source_text(const VehicleMeasurements& m);

/// The verdict, what is wrong with what to do, what passed, and what only a person can check.
std::string checks_text(const VehicleMeasurements& m, const std::vector<Check>& checks);

/// Schema karst.vehicle_preflight/1 (docs/preflight.md).
nlohmann::ordered_json to_json(const VehicleMeasurements& m, const std::vector<Check>& checks);

}  // namespace karst::preflight
