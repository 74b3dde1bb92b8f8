// The core's end of the connection to a vehicle: the greeting, and messages that the core may take.
#pragma once
#include <optional>
#include <string>

#include "plugins/socket/stream.h"

namespace karst::socket {

/// A message that came.
struct Received {
  std::optional<ToCore> message;  // none: its numbers are such that the core must not take it
};

class VehicleLink {
 public:
  /// Connects, greets, and waits for the vehicle's description, each for `patience` at most. Throws
  /// core::InputError naming the address if there is no vehicle, if it refuses, or if it cannot be flown.
  VehicleLink(const Address& address, const Hello& hello, Wait patience);

  const core::VehicleDescription& description() const { return welcome_.description; }
  const std::string& address() const { return address_; }
  Stream& stream() { return stream_; }
  /// What the next message is, if one comes within `patience`. Throws LinkError if the vehicle is gone, says
  /// goodbye, or sends what is no message.
  std::optional<Received> receive_one(Wait patience);
  /// The next message that the core may take.
  std::optional<ToCore> receive(Wait patience);
  /// Whether any bytes came since the last call.
  bool heard() { return std::exchange(heard_, false); }

  /// Holds unless messages were dropped; says how many, and why the first one was.
  core::VehicleCheck plausibility() const;

  /// Says goodbye, if the vehicle still listens.
  void leave(const std::string& reason);

 private:
  std::optional<Frame> next_frame(Wait patience);
  Welcome greet(const Hello& hello, Wait patience);

  std::string address_;
  Stream stream_;
  bool heard_ = false;
  std::size_t dropped_ = 0;
  std::string first_dropped_;
  Welcome welcome_;
};

/// Hands a message of a sensor or of the vehicle's state to `sink`; others are ignored.
void deliver(ToCore message, const core::VehicleDescription& vehicle, core::VehicleSink& sink);

}  // namespace karst::socket
