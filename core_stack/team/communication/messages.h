// The team's radio messages and their wire format (docs/homing.md gives the layout byte by byte).
//
// A robot's *records* are facts that all others must receive: nodes and rays of the homing tree, claims,
// landings, objects of interest. They are numbered and independent of each other, and gossip.h delivers them.
// A robot's *state* matters only while it is recent. A *frame* is one transmission: at most kFrameBytes, with
// a version and an authentication tag that requires the mission's key. No record is longer than a frame;
// longer data is split into several records.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <variant>

#include "core_stack/homing/path_home/tree_facts.h"
#include "core_stack/team/communication/mission_key.h"
#include "core_stack/team/communication/wire.h"

namespace karst::core {

constexpr std::size_t kFrameBytes = 208;
constexpr std::uint8_t kWireVersion = 2;
constexpr RobotId kMaxRobots = 32;  // radios, the base's included: a frame holds a version vector of all
constexpr double kMaxCoordinate_m = 40000;
constexpr std::uint32_t kMaxNumber = 1u << 24;  // of a robot's nodes, records or claims

/// aside: it waits where others can pass; boxed: it found no such place, and others make room.
enum class TeamPhase : std::uint8_t { standby, explore, home, landing, landed, relay, lost, aside, boxed };

constexpr bool in_the_air(TeamPhase p) {
  return p == TeamPhase::explore || p == TeamPhase::home || p == TeamPhase::landing ||
         p == TeamPhase::aside || p == TeamPhase::boxed;
}

/// Link quality from another robot: the fraction of its frames that arrive.
struct RadioContact {
  RobotId robot = 0;
  double quality = 0;  // 0..1
};

/// World frame. On the wire, positions are rounded to centimetres, velocities to cm/s, times to milliseconds,
/// quality to 1/255, and the seconds left to whole seconds (65535 at most).
struct TeamState {
  RobotId robot = 0;
  TimeNs stamp = 0;
  Vec3 position = Vec3::Zero();
  Vec3 velocity_mps = Vec3::Zero();
  TeamPhase phase = TeamPhase::standby;
  double seconds_left = 0;
  std::vector<RadioContact> heard;  // at most kMaxRobots
};

/// A goal that a robot is about to explore. A later claim replaces the robot's earlier one.
struct GoalClaim {
  TimeNs stamp = 0;
  Vec3 position = Vec3::Zero();
  bool given_up = false;
};
/// A site where a robot is about to land or has landed. `hover` is straight above it.
struct LandingClaim {
  enum class State : std::uint8_t { claimed, landed, given_up };
  TimeNs stamp = 0;
  Vec3 ground = Vec3::Zero(), hover = Vec3::Zero();
  State state = State::claimed;
};
struct ObjectSeen {
  TimeNs stamp = 0;
  std::uint32_t object = 0;  // the finder's own number for it
  std::uint8_t kind = 0;     // ObjectKind; 0: withdrawn, as it is the same as another of the finder's
  Vec3 position = Vec3::Zero();
  double deviation_m = 0;  // root-mean-square position error, 0 to 25.5 m
};
/// How many records of each robot the base holds, counted from the first. The base sends it so that finders
/// know what has arrived.
struct Receipt {
  struct Row {
    RobotId robot = 0;
    std::uint32_t records = 0;
  };
  std::vector<Row> rows;  // at most kMaxRobots
};

using Record = std::variant<TreeFacts, GoalClaim, LandingClaim, ObjectSeen, Receipt>;

/// Why bytes were refused.
enum class Refusal : std::uint8_t {
  too_short,  // or longer than a frame
  no_frame,   // not a frame of this protocol
  version,
  forged,     // or damaged: the tag does not match the mission's key
  truncated,  // its length does not match its content
  kind,       // of frame, record, node, phase
  range,      // an id, count, position or time out of range
  stranger,   // the sender is not in the team
  replayed,   // it was received before
  stale       // sent too long ago, or stamped later than now
};
constexpr std::size_t kRefusals = 10;

/// Serializes a record. Returns nothing if a number is not finite or out of range, or if the result is longer
/// than max_record_bytes(); split tree facts first.
std::optional<Bytes> write_record(const Record& record);
constexpr std::size_t max_record_bytes() { return kFrameBytes - 32; }
/// Parses exactly one record; on refusal sets `why`.
std::optional<Record> read_record(std::span<const std::uint8_t> bytes, Refusal& why);

/// Splits tree facts into pieces that each fit a record. Facts with numbers out of range are dropped.
std::vector<TreeFacts> split(const TreeFacts& facts);

/// A record in transit, identified by author and sequence number (from 1).
struct SentRecord {
  RobotId author = 0;
  std::uint32_t number = 0;
  Bytes bytes;
};
/// Which of an author's records a robot holds: the first `first`, and number first + 2 + i for each set bit i
/// of `beyond`. It lacks number first + 1.
struct Held {
  RobotId author = 0;
  std::uint32_t first = 0;
  std::uint32_t beyond = 0;
};

/// The only kind of frame: the sender's state, its version vector, and as many other states and records as
/// fit. Each part may be missing.
struct Frame {
  RobotId sender = 0;
  bool reports_held = false;        // `held` is complete
  TimeNs sent = 0;                  // in whole milliseconds
  std::uint16_t sequence = 0;       // counts the sender's frames: gaps show losses
  std::vector<TeamState> states{};  // its own first, then others' as known to it
  std::vector<Held> held{};
  std::vector<SentRecord> records{};
};
/// Returns nothing if the frame is longer than kFrameBytes or a part cannot be written.
std::optional<Bytes> write_frame(const Frame& frame, const MissionKey& key);
/// Memory use is bounded by a small multiple of the bytes given.
std::optional<Frame> read_frame(std::span<const std::uint8_t> bytes, const MissionKey& key, Refusal& why);

/// The size of each part, for filling a frame.
std::size_t state_bytes(const TeamState& s);
std::size_t held_bytes(const Held& h);
std::size_t record_bytes(const SentRecord& r);
constexpr std::size_t kEmptyFrameBytes = 2 + 1 + 1 + 4 + 2 + 3 + kTagBytes;

}  // namespace karst::core
