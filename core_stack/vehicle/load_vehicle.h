// Vehicle plugins are loaded by name: `vehicle = simulator` opens libkarst_vehicle_simulator.so.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// Names of the vehicles that `folder` holds, in alphabetical order.
std::vector<std::string> vehicles_in(const std::filesystem::path& folder);

/// Opens the plugin from `folder`; it stays loaded. Throws InputError naming what the folder does hold.
VehiclePlugin& load_vehicle(const std::string& name, const std::filesystem::path& folder);

}  // namespace karst::core
