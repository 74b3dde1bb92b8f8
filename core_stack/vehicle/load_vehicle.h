// Vehicle plugins are loaded by name: `vehicle = simulator` opens libkarst_vehicle_simulator.so.
#pragma once
#include <filesystem>
#include <string>

#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// Opens the plugin from `folder`; it stays loaded. Throws InputError naming what the folder does hold.
VehiclePlugin& load_vehicle(const std::string& name, const std::filesystem::path& folder);

}  // namespace karst::core
