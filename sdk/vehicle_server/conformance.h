// Whether a vehicle keeps the protocol (docs/vehicle_protocol.md): what `karst vehicle check` looks at.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "plugins/socket/address.h"

namespace karst::vehicle_server {

enum class Verdict { passed, failed, skipped };

struct Finding {
  std::string name;
  Verdict verdict = Verdict::passed;
  std::string detail;
};

struct ConformanceOptions {
  bool takes_off = false;  // lifts off by a few decimetres, and then gives no more commands
  double seconds = 3;      // of watching in each mode
};

/// Connects several times, and reports each finding as it is known. Throws core::InputError if nothing
/// answers.
std::vector<Finding> check_vehicle(const socket::Address& address, const ConformanceOptions& options,
                                   const std::function<void(const Finding&)>& report);

}  // namespace karst::vehicle_server
