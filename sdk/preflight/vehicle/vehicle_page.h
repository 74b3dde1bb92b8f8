// The checks of a vehicle as a page of A4 to print: go or no-go, plots, and boxes for what only a person can
// check.
#pragma once
#include <string>

#include "sdk/preflight/vehicle/vehicle_rules.h"

namespace karst::preflight {

std::string vehicle_page(const VehicleMeasurements& m, const std::vector<Check>& checks);

}  // namespace karst::preflight
