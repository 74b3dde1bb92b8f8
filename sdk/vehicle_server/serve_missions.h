// Serves the vehicle of a mission to clients that connect one after another (docs/vehicle_protocol.md).
#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "plugins/socket/address.h"
#include "sdk/flight/mission_file.h"

namespace karst::vehicle_server {

struct ServeRequest {
  socket::Address address;
  std::filesystem::path truth;  // folder for ground truth, one folder a mission in it: 1, 2, ...; "": none
  int threads = 1;
  bool once = false;  // ends after the first mission
};

/// What a user is told.
struct ServeNotes {
  std::function<void(const std::string& address)> listening;
  std::function<void(const std::string& ending, const std::filesystem::path& truth)> mission_over;
  std::function<void(const std::string& why)>
      not_flown;  // a client that left before the start, or was refused
};

/// Serves until `interrupted`, or once. The cave, the start and the vehicle's options are the mission's; the
/// seed and the height of the take-off are the client's. Throws core::InputError if the vehicle cannot be
/// made or the address cannot be had.
void serve_missions(const flight::Mission& mission, const ServeRequest& request, const ServeNotes& notes,
                    const std::atomic<bool>& interrupted);

}  // namespace karst::vehicle_server
