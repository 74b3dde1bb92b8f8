// A client that says what it is told to, right or wrong, and keeps what the vehicle sends.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "plugins/socket/stream.h"

namespace karst::vehicle_server {

/// A message, and when it came: lockstep by the vehicle's clock, real time by the machine's.
struct Heard {
  socket::ToCore message;
  core::TimeNs at = 0;
};

class ConformanceClient {
 public:
  explicit ConformanceClient(const socket::Address& address);
  /// Says goodbye, and waits for the vehicle to close the connection: then it is there for the next client.
  ~ConformanceClient();
  ConformanceClient(const ConformanceClient&) = delete;
  ConformanceClient& operator=(const ConformanceClient&) = delete;

  socket::Stream& stream() { return stream_; }
  template <class M>
  void say(const M& message) {
    stream_.queue(message);
    stream_.flush(socket::Wait(2000));
  }
  void say_bytes(const std::string& bytes);
  /// Throws socket::LinkError if it cannot be read, or the vehicle is gone.
  std::optional<socket::ToCore> hear(socket::Wait patience);
  /// Greets and returns the welcome; throws socket::LinkError with what came instead.
  socket::Welcome greet(socket::FlightClock clock);

  /// In lockstep: starts it, or flies on until `until`, with `command` each 10 ms if there is one. Keeps all
  /// that came.
  void start();
  void fly(core::TimeNs until, const std::optional<core::Command>& command, std::vector<Heard>& heard);
  /// In real time, for `time`.
  void fly_real_time(core::TimeNs time, const std::optional<core::Command>& command,
                     std::vector<Heard>& heard);

  core::TimeNs now() const { return now_; }
  std::size_t schedules() const { return schedules_; }

 private:
  struct Slot {
    std::uint32_t number;
    core::TimeNs period;
  };
  void take_answer(std::vector<Heard>& heard);

  socket::Stream stream_;
  core::TimeNs now_ = 0, next_command_ = 10 * core::kMillisecond;
  std::size_t schedules_ = 0;
  std::map<std::pair<core::TimeNs, std::size_t>, Slot> slots_;  // by due time and order
};

}  // namespace karst::vehicle_server
