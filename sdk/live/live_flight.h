// A flight that is followed: its record, while it is written, becomes messages for who is connected.
#pragma once
#include <atomic>
#include <filesystem>
#include <string>
#include <thread>

#include "sdk/live/flight_messages.h"
#include "sdk/live/live_server.h"
#include "sdk/live/record_feed.h"

namespace karst::live {

class LiveFlight {
 public:
  /// `stored_map`: where the run's map will be, as OctoMap's file. Listens from now on, on a thread without
  /// priority. Throws core::InputError naming the address, or if it is not this machine's own and there is no
  /// token.
  LiveFlight(LiveSetup setup, double map_resolution_m, std::filesystem::path stored_map = {});
  /// Once the record is complete. Gives clients setup.limits.farewell to read what waits.
  ~LiveFlight();
  LiveFlight(const LiveFlight&) = delete;
  LiveFlight& operator=(const LiveFlight&) = delete;

  core::RecordListener& listener() { return feed_; }
  Endpoint endpoint() const { return server_.endpoint(); }

 private:
  void run() noexcept;
  bool tick();
  void end();

  const std::function<void(const std::string&)> log_;
  const std::filesystem::path stored_map_;
  RecordFeed feed_;
  LiveServer server_;
  FlightMessages messages_;
  std::uint64_t lost_ = 0, told_ns_ = 0;
  bool ended_ = false;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

}  // namespace karst::live
