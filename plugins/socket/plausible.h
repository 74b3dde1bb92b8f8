// What the numbers of a vehicle's messages must be, so that the core may take them.
#pragma once
#include <string>

#include "plugins/socket/messages.h"

namespace karst::socket {

/// Why a vehicle of this description cannot be flown; "" if it can.
std::string implausible(const core::VehicleDescription& vehicle);

/// Why the core must not take this message of the vehicle; "" if it may.
std::string implausible(const ToCore& message, const core::VehicleDescription& vehicle);

/// Why a vehicle must not be made for this client; "" if it may.
std::string implausible(const Hello& hello);

/// Why a vehicle must not follow this command: a number that is none. "" if it may.
std::string implausible(const core::Command& command);

}  // namespace karst::socket
