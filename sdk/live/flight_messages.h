// The messages of a flight, of its record as it grows: those that an export of the finished run has, byte for
// byte, but for the times at which /path and /map tell what has grown until then.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core_stack/mission/recording/record_listener.h"
#include "sdk/live/live_topic.h"
#include "sdk/mcap_export/event_messages.h"
#include "sdk/mcap_export/flight_messages.h"

namespace karst::live {

/// All that can be served of a flight.
const std::vector<LiveTopic>& flight_topics();
/// Their places in the list.
std::size_t map_topic();
std::size_t new_cells_topic();

/// When what grows is told whole: each second at first, then at intervals of a fortieth of the flight time.
/// So what is sent of it in all is at most about forty times the last message.
class SnapshotTimes {
 public:
  double due_s() const { return due_s_; }
  void told() { due_s_ += std::max(1.0, std::floor(due_s_ / 40)); }

 private:
  double due_s_ = 1;
};

/// Not thread-safe. Flight time 0 is 1970, as in an export.
class FlightMessages {
 public:
  using Sink = std::function<void(LiveMessage)>;
  FlightMessages(double map_resolution_m, Sink sink)
      : resolution_m_(map_resolution_m), sink_(std::move(sink)) {}

  /// What the recorder wrote. Throws std::runtime_error if it is nothing a recorder writes.
  void take(core::RecordPart part, std::string_view bytes);
  /// What is left once the record is complete. `stored`: the map as it was written; null where it could not
  /// be.
  void end(const core::VoxelMap* stored = nullptr);

  std::uint64_t time_ns() const { return clock_.ns(now_s_); }
  std::size_t map_cells() const { return occupied_.size(); }

 private:
  struct Velocity {
    double t_s = 0;
    core::Vec3 velocity_mps;
  };
  struct Sigmas {
    double used_s = 0;
    mcap::PoseSigmas sigmas;
  };
  struct NewCell {
    std::int32_t from_ms = 0;
    core::CellKey key;
  };

  void take_event(std::string_view line);
  void take_pose(std::string_view line);
  void take_telemetry(std::string_view line);
  void take_localization(std::string_view line);
  void take_growth(std::string_view record);
  void advance(double t_s);
  void tell_odometry(const evaluation::StampedPose& after);
  void tell_path(double t_s);
  void tell_map(double t_s);
  void tell_new_cells();
  template <class M>
  void put(const char* topic, double t_s, const M& message);
  template <class M>
  void put(const char* topic, std::optional<mcap::Stamped<M>> made);

  const double resolution_m_;
  const Sink sink_;
  const mcap::FlightClock clock_;
  double now_s_ = 0;

  mcap::EventMessages events_;
  mcap::BatteryPace battery_;

  std::optional<evaluation::StampedPose> before_, last_;  // /odometry is one pose behind
  std::deque<Velocity> velocities_;
  std::deque<Sigmas> sigmas_;
  mcap::FlownPath path_;
  SnapshotTimes path_times_, map_times_;

  std::unordered_map<core::CellKey, std::int32_t, core::CellKeyHash> occupied_;  // and since when, ms
  std::vector<NewCell> new_cells_;                                               // not yet told
};

}  // namespace karst::live
