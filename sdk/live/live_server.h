// Serves a flight to clients on the network: Foxglove's protocol by WebSocket, and a page that follows the
// flight by HTTP, at one address.
//
// All of it runs on the thread that calls run(). Whatever clients do costs that thread's time alone, and
// memory within LiveLimits.
#pragma once
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "sdk/live/access.h"
#include "sdk/live/foxglove.h"
#include "sdk/live/retained.h"

namespace karst::live {

struct LiveLimits {
  std::size_t connections = 64;  // more are closed at once
  std::size_t clients = 16;      // of them, by WebSocket
  std::size_t header_bytes = 8192, request_bytes = 65536;
  std::chrono::milliseconds handshake{5000};  // from the connection to the end of the HTTP request
  std::chrono::milliseconds idle{20000};      // a client that answers no ping is left
  std::chrono::milliseconds stuck{30000};     // and one that takes no message
  std::chrono::milliseconds farewell{2000};   // after the flight, for clients to read what waits
};

struct LiveSetup {
  Endpoint endpoint;
  std::string token;  // "": anybody
  std::string name, session;
  std::map<std::string, std::string> metadata = {};
  LiveLimits limits = {};
  std::function<void(const std::string&)> log = [](const std::string&) {
  };  // twenty lines, and then one a second
};

class LiveServer {
 public:
  /// Binds and listens. Throws core::InputError naming the address. `topics` as of Retained.
  LiveServer(LiveSetup setup, Retained topics);
  ~LiveServer();

  /// With the port that the system chose.
  Endpoint endpoint() const;

  /// Serves, calling `tick` every 50 ms, until it returns false; then says farewell to the clients.
  void run(const std::function<bool()>& tick);
  /// Within `tick` only.
  void publish(const LiveMessage& message);
  void tell_time(std::uint64_t time_ns);
  void tell(StatusLevel level, const std::string& text, const std::string& id = "");
  std::size_t clients() const;

 private:
  class Network;
  std::unique_ptr<Network> network_;
};

}  // namespace karst::live
