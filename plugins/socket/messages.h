// What the core and a vehicle in another process tell each other (docs/vehicle_protocol.md). Times are
// nanoseconds of the clock of whoever sends the message.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core_stack/vehicle/vehicle.h"

namespace karst::socket {

constexpr std::uint32_t kMagic = 0x4556524b;  // "KRVE" in the order of the bytes
constexpr std::uint16_t kVersion = 1;
constexpr std::uint16_t kRgbCamera = 0xffff;  // in place of a camera's number: the colour camera

enum class FlightClock : std::uint8_t { lockstep, real_time };
constexpr auto names_of(FlightClock) {
  using enum FlightClock;
  return std::to_array<core::Named<FlightClock>>({{lockstep, "lockstep"}, {real_time, "real_time"}});
}

// From the core.
struct Hello {
  std::uint32_t magic = kMagic;
  std::uint16_t version = kVersion;
  FlightClock clock = FlightClock::lockstep;
  std::uint64_t seed = 1;  // of the mission, for a vehicle that is simulated
  double climb_m = 0;      // by which it will rise from where it stands
  std::string client;
};
struct Start {};
/// Lockstep: run what was scheduled as `slot`, which is due at `time`.
struct Run {
  std::uint32_t slot = 0;
  core::TimeNs time = 0;
};
struct Resume {};
struct Ping {
  core::TimeNs sent = 0;
};
/// From either side: nothing more will come.
struct Bye {
  std::string reason;
};

// From the vehicle.
struct Welcome {
  std::uint32_t magic = kMagic;
  std::uint16_t version = kVersion;
  bool lockstep = false, real_time = false;  // the clocks that it can fly by
  core::VehicleDescription description;
};
struct Refuse {
  std::string reason;
};
struct Checks {
  std::vector<core::VehicleCheck> checks;
};
/// Lockstep: the core shall run `slot` at `due`, and each `period` from then on unless that is 0.
struct Schedule {
  std::uint32_t slot = 0;
  core::TimeNs due = 0, period = 0;
};
/// Lockstep: the core shall take the messages so far, and answer by Resume, before the vehicle goes on.
struct Pause {};
/// The answer to Start and Run is complete.
struct Done {
  core::TimeNs time = 0;
};
struct Pong {
  core::TimeNs ping_sent = 0, received = 0, sent = 0;
};
struct Depth {
  std::uint16_t camera = 0;
  core::DepthImage image;
};
/// Written as Depth.
struct DepthView {
  std::uint16_t camera;
  const core::DepthImage& image;
};
struct Objects {
  std::uint16_t camera = 0;  // or kRgbCamera
  core::ObjectDetections look;
};
struct Ground {
  core::TimeNs stamp = 0;
};
struct LiftOff {
  core::TimeNs stamp = 0;
};
struct AuthorityChange {
  core::TimeNs stamp = 0;
  core::Authority who = core::Authority::core;
  std::string reason;
};
struct Lost {
  core::TimeNs stamp = 0;
  core::MissionOutcome outcome = core::MissionOutcome::lost;
  std::string reason;
};

using ToVehicle = std::variant<Hello, Start, Run, Resume, core::Command, Ping, Bye>;
using ToCore =
    std::variant<Welcome, Refuse, Checks, Schedule, Pause, Done, Pong, Bye, core::ImuSample,
                 core::MagnetometerSample, core::BarometerSample, core::PoseSample, core::BatteryStatus,
                 core::LidarScan, Depth, core::RgbFrame, Objects, Ground, LiftOff, AuthorityChange, Lost>;

/// A peer's times beyond this (73 years) are refused: no sum or difference of those within it overflows.
constexpr core::TimeNs kMaxTime = core::TimeNs{1} << 61;
constexpr bool is_plausible_time(core::TimeNs t) { return t > -kMaxTime && t < kMaxTime; }

/// Where a message has its stamp; null for those without.
struct StampOf {
  const core::TimeNs* operator()(const auto&) const { return nullptr; }
  const core::TimeNs* operator()(const Depth& m) const { return &m.image.stamp; }
  const core::TimeNs* operator()(const Objects& m) const { return &m.look.stamp; }
  template <class M>
  requires requires(const M& m) { m.stamp; }
  const core::TimeNs* operator()(const M& m) const { return &m.stamp; }
};
inline const core::TimeNs* stamp_of(const ToCore& message) { return std::visit(StampOf{}, message); }
inline core::TimeNs* stamp_of(ToCore& message) {
  return const_cast<core::TimeNs*>(stamp_of(std::as_const(message)));
}

/// What a type is called, and its number on the wire.
struct MessageType {
  std::uint16_t id;
  const char* name;
};
template <class M>
inline constexpr MessageType kType{};
template <>
inline constexpr MessageType kType<Hello>{1, "hello"};
template <>
inline constexpr MessageType kType<Start>{2, "start"};
template <>
inline constexpr MessageType kType<Run>{3, "run"};
template <>
inline constexpr MessageType kType<Resume>{4, "resume"};
template <>
inline constexpr MessageType kType<core::Command>{5, "command"};
template <>
inline constexpr MessageType kType<Ping>{6, "ping"};
template <>
inline constexpr MessageType kType<Bye>{7, "bye"};
template <>
inline constexpr MessageType kType<Welcome>{32, "welcome"};
template <>
inline constexpr MessageType kType<Refuse>{33, "refuse"};
template <>
inline constexpr MessageType kType<Checks>{34, "checks"};
template <>
inline constexpr MessageType kType<Schedule>{35, "schedule"};
template <>
inline constexpr MessageType kType<Pause>{36, "pause"};
template <>
inline constexpr MessageType kType<Done>{37, "done"};
template <>
inline constexpr MessageType kType<Pong>{38, "pong"};
template <>
inline constexpr MessageType kType<core::ImuSample>{48, "imu"};
template <>
inline constexpr MessageType kType<core::MagnetometerSample>{49, "magnetometer"};
template <>
inline constexpr MessageType kType<core::BarometerSample>{50, "barometer"};
template <>
inline constexpr MessageType kType<core::PoseSample>{51, "pose"};
template <>
inline constexpr MessageType kType<core::BatteryStatus>{52, "battery"};
template <>
inline constexpr MessageType kType<core::LidarScan>{53, "lidar"};
template <>
inline constexpr MessageType kType<Depth>{54, "depth"};
template <>
inline constexpr MessageType kType<DepthView>{54, "depth"};
template <>
inline constexpr MessageType kType<core::RgbFrame>{55, "rgb"};
template <>
inline constexpr MessageType kType<Objects>{56, "objects"};
template <>
inline constexpr MessageType kType<Ground>{57, "ground"};
template <>
inline constexpr MessageType kType<LiftOff>{58, "lift_off"};
template <>
inline constexpr MessageType kType<AuthorityChange>{59, "authority"};
template <>
inline constexpr MessageType kType<Lost>{60, "lost"};

}  // namespace karst::socket
