// The vehicle's end of the connection: puts any core::Vehicle behind a socket, for one mission of one client.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "plugins/socket/stream.h"

namespace karst::socket {

/// Makes the vehicle that a client asks for. Throws core::InputError, whose words the client is told.
using MakeVehicle = std::function<std::unique_ptr<core::Vehicle>(const Hello&)>;

struct ServeOptions {
  int threads = 1;                                  // of the vehicle's jobs
  Wait greeting_patience{10'000};                   // for the client's first message
  Wait start_patience{600'000};                     // from the greeting to the start
  Wait lockstep_patience{600'000};                  // between two requests
  core::TimeNs forget_client = 10 * core::kSecond;  // in real time: a client so long silent is gone
};

struct Served {
  bool flew = false;   // the client started the vehicle
  std::string ending;  // why the mission is over for the vehicle
};

/// Serves one client to the end of its mission. A client that is gone leaves a vehicle that comes down by
/// itself: that is waited for. Throws what the vehicle throws when it is finished, such as core::InputError
/// for a full disk.
Served serve_client(Stream& client, const MakeVehicle& make, const ServeOptions& options,
                    const std::atomic<bool>& interrupted);

/// While it lives, whoever else connects is told that the vehicle is in use.
class Doorkeeper {
 public:
  explicit Doorkeeper(Listener& listener);

 private:
  std::jthread thread_;
};

}  // namespace karst::socket
