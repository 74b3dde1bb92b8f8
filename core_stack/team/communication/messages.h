// What the team says over the radio, and how it is written (docs/homing.md has the layout byte by byte).
//
// A robot's *records* are what the others must come to know for good: nodes and rays of the homing tree,
// claims, landings, objects of interest. They are numbered, each stands by itself, and gossip.h sees to it
// that they arrive. Its *state* is only of interest while it is new. A *frame* is what is sent at once: at
// most kFrameBytes, with a version and a tag that only who holds the mission's key can make. Nothing is
// longer than a frame; what is, is said in several records.
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
constexpr RobotId kMaxRobots = 32;  // radios, the base's among them: what each holds of all fits a frame
constexpr double kMaxCoordinate_m = 40000;
constexpr std::uint32_t kMaxNumber = 1u << 24;  // of a robot's nodes, records or claims

/// aside: it hovers where others get by, and waits; boxed: it has no such place, and others make room.
enum class TeamPhase : std::uint8_t { standby, explore, home, landing, landed, relay, lost, aside, boxed };

constexpr bool in_the_air(TeamPhase p) {
  return p == TeamPhase::explore || p == TeamPhase::home || p == TeamPhase::landing ||
         p == TeamPhase::aside || p == TeamPhase::boxed;
}

/// How well one robot hears another: the share of its frames that arrive.
struct RadioContact {
  RobotId robot = 0;
  double quality = 0;  // 0..1
};

/// World frame. Positions are rounded to centimetres, velocities to cm/s, times to milliseconds, quality to
/// 1/255, seconds left to whole ones (65535 at most).
struct TeamState {
  RobotId robot = 0;
  TimeNs stamp = 0;
  Vec3 position = Vec3::Zero();
  Vec3 velocity_mps = Vec3::Zero();
  TeamPhase phase = TeamPhase::standby;
  double seconds_left = 0;
  std::vector<RadioContact> heard;  // at most kMaxRobots
};

/// A place that a robot is about to look at; a later claim replaces an earlier one of the same robot.
struct GoalClaim {
  TimeNs stamp = 0;
  Vec3 position = Vec3::Zero();
  bool given_up = false;
};
/// A place that a robot is about to land at, or has landed at. `hover` is straight above it.
struct LandingClaim {
  enum class State : std::uint8_t { claimed, landed, given_up };
  TimeNs stamp = 0;
  Vec3 ground = Vec3::Zero(), hover = Vec3::Zero();
  State state = State::claimed;
};
struct ObjectSeen {
  TimeNs stamp = 0;
  std::uint32_t object = 0;  // the finder's own number for it
  std::uint8_t kind = 0;     // ObjectKind; 0: taken back, it is another one of the finder's numbers
  Vec3 position = Vec3::Zero();
  double deviation_m = 0;  // root of the squared distance to be expected, 0 to 25.5 m
};
/// "I hold the first `records` records of each of these": said by the base, so that finders know what
/// arrived.
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
  no_frame,   // of another kind of sender
  version,
  forged,     // or damaged: the tag is not that of the mission's key
  truncated,  // says it holds more than it does, or holds more than it says
  kind,       // of frame, record, node, phase
  range,      // ids, counts, places, times beyond what can be
  stranger,   // the sender is not in the team
  replayed,   // it was heard before
  stale       // sent too long ago, or later than now
};
constexpr std::size_t kRefusals = 10;

/// How a record is written. Nothing if it cannot be: a number that is not finite or out of range, or longer
/// than max_record_bytes(); split tree facts first.
std::optional<Bytes> write_record(const Record& record);
constexpr std::size_t max_record_bytes() { return kFrameBytes - 32; }
/// Reads exactly one record; on refusal `why` says so.
std::optional<Record> read_record(std::span<const std::uint8_t> bytes, Refusal& why);

/// Tree facts in pieces that each fit a record. Numbers a record cannot carry are left out.
std::vector<TreeFacts> split(const TreeFacts& facts);

/// A record under way: written by `author` as its `number`-th, from 1.
struct SentRecord {
  RobotId author = 0;
  std::uint32_t number = 0;
  Bytes bytes;
};
/// What a robot holds of an author's records: the first `first`, and of those behind the next one (which it
/// lacks) number first + 2 + i where bit i is set.
struct Held {
  RobotId author = 0;
  std::uint32_t first = 0;
  std::uint32_t beyond = 0;
};

/// The one kind of frame there is: the sender's state, what it holds, and as many other states and records as
/// have room; each part may be missing.
struct Frame {
  RobotId sender = 0;
  bool reports_held = false;        // `held` is the whole of what it holds
  TimeNs sent = 0;                  // in whole milliseconds
  std::uint16_t sequence = 0;       // of the sender's frames: gaps show what was lost
  std::vector<TeamState> states{};  // its own first, others' as it knows them
  std::vector<Held> held{};
  std::vector<SentRecord> records{};
};
/// Nothing if it would be longer than kFrameBytes or holds what cannot be written.
std::optional<Bytes> write_frame(const Frame& frame, const MissionKey& key);
/// Never takes more memory than a small multiple of the bytes given.
std::optional<Frame> read_frame(std::span<const std::uint8_t> bytes, const MissionKey& key, Refusal& why);

/// Bytes each part takes, to fill a frame.
std::size_t state_bytes(const TeamState& s);
std::size_t held_bytes(const Held& h);
std::size_t record_bytes(const SentRecord& r);
constexpr std::size_t kEmptyFrameBytes = 2 + 1 + 1 + 4 + 2 + 3 + kTagBytes;

}  // namespace karst::core
