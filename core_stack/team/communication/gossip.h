// Store and forward: every robot receives every record of every other robot over intermittent links that lose
// and corrupt frames.
//
// Each robot broadcasts its state and a version vector of the records it holds once a period, and three times
// as often while its neighbours do not hold the same records or another robot flies nearby. Each robot sends
// the records its peer lacks (anti-entropy; Demers et al., Epidemic Algorithms for Replicated Database
// Maintenance, 1987). A robot that receives a new record forwards it after a random wait, unless it has heard
// another robot send it by then, or knows that all robots in contact hold it: the radio is a broadcast
// medium, so one sender among several neighbours suffices. The protocol assumes nothing about contact: the
// first robot that meets one that was away for an hour brings it up to date. Gaps in the sequence numbers of
// received frames measure link quality. Each frame is accepted once and only while it is recent
// (replay_window.h), and its content only if it is plausible (plausible.h).
#pragma once
#include <array>
#include <optional>

#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/team/communication/plausible.h"
#include "core_stack/team/communication/record_store.h"
#include "core_stack/team/communication/replay_window.h"

namespace karst::core {

constexpr std::size_t kFewRadios = 8;  // with no more, one frame a period reports all states often enough
/// Worst state age in a multi-hop chain, in periods per radio; measured: 0.9 to 1.7.
constexpr double kPeriodsPerRadio = 1.8;

struct GossipOptions {
  double period_s = 1.0;             // between broadcasts of its state and version vector
  double bytes_per_s = 1120;         // mean rate of its own frames; a burst may hold ten frames
  double contact_age_s = 5.0;        // a robot silent for longer is out of contact, an older frame is stale
  std::int64_t max_records = 20000;  // of one robot
};
void describe(OptionTable& t, GossipOptions& o);

struct GossipCounts {
  std::uint64_t frames_sent = 0, bytes_sent = 0, frames_heard = 0, bytes_heard = 0;
  std::array<std::uint64_t, kRefusals> refused{};  // frames, by Refusal
  std::uint64_t records_refused = 0;  // in valid frames: malformed, implausible, too far ahead, too many
  std::uint64_t states_refused = 0;   // implausible
  std::uint64_t claims_refused = 0;   // a peer claims more of its records than exist
  std::uint64_t contradictions = 0;   // different bytes under a known number
  std::uint64_t records_taken = 0, records_again = 0;
};

struct Delivery {
  RobotId author = 0;
  std::uint32_t number = 0;
  Record record;
};

class Gossip {
 public:
  /// The seed only randomizes waits.
  Gossip(const TeamRadio& radio, const GossipOptions& options, std::uint64_t seed);

  /// Adds a new record of its own; splits tree facts. Returns the number of the last record made of it, or 0
  /// if it cannot be written or the store is full.
  std::uint32_t publish(const Record& record);
  /// Sets the state to broadcast with the next frame; `robot` and `heard` are filled in.
  void set_state(const TeamState& state) { state_ = state; }
  /// Broadcasts its state more often while another vehicle is near.
  void hurry(bool near) { hurried_ = near; }

  /// Bytes from the radio.
  void receive(std::span<const std::uint8_t> bytes, TimeNs now);
  /// Returns the frames to send now. Call it ten times a second; `now` must not decrease.
  std::vector<Bytes> send(TimeNs now);

  /// Records received from others since the last call, each once, in order of arrival.
  std::vector<Delivery> take_delivered();
  /// The newest known state of each other robot, by robot.
  std::vector<TeamState> states() const;
  /// Its own state as last broadcast, with its radio contacts; a relay graph needs it beside the others'.
  const TeamState& reported_state() const { return state_; }
  /// Robots heard recently and since `since`, with the fraction of their frames that arrived.
  std::vector<RadioContact> contacts(TimeNs now, TimeNs since) const;

  /// The receipt that the base publishes whenever a record has arrived that its author waits for.
  Receipt receipt() const;
  const HeldNumbers& held(RobotId author) const { return store_.held(author); }
  /// How many of its own records, counted from the first, the base is known to hold, from frames of the base
  /// itself or from its receipts.
  std::uint32_t known_at_base() const { return known_at_base_; }
  const GossipCounts& counts() const { return counts_; }
  RobotId self() const { return radio_.self; }

 private:
  struct Peer {
    std::optional<TimeNs> heard_at;
    ReplayWindow replays;
    std::uint16_t sequence = 0;
    double quality = 1;
    std::array<HeldNumbers, kMaxRobots> held{};
  };
  struct Reported {
    std::optional<TimeNs> stamp;
    int times = 0;
  };
  struct Waiting {
    TimeNs due;
    RobotId author;
    std::uint32_t number;
  };

  bool in_contact(const Peer& p, TimeNs now) const;
  std::optional<Refusal> refused(const Frame& frame, TimeNs now) const;
  void take_frame(const Frame& frame, TimeNs now);
  void take_newest(const Frame& frame, TimeNs now);
  void take_held(const Frame& frame, TimeNs now);
  void take_state(const TeamState& s, TimeNs now);
  void take_record(const SentRecord& r, RobotId from, TimeNs now);
  bool may_be_reminded(TimeNs now) const;
  void known_to_hold(std::uint32_t own_records);
  void answer(RobotId peer, TimeNs now);
  void queue(RobotId author, std::uint32_t number, TimeNs due);
  bool wanted(const Waiting& w, TimeNs now) const;
  bool unsettled(TimeNs now) const;
  Frame own_news(TimeNs now);
  std::size_t add_states(Frame& frame, std::size_t& room);
  bool of_many() const;
  void report_more_states(std::size_t passed, TimeNs now, std::vector<Bytes>& out);
  void finish(Frame& frame, TimeNs now, std::vector<Bytes>& out);
  TimeNs wait();

  TeamRadio radio_;
  GossipOptions options_;
  Random random_;
  RecordStore store_;
  TeamState state_;
  std::array<Peer, kMaxRobots> peers_;
  std::array<std::optional<TeamState>, kMaxRobots> states_;
  std::array<Reported, kMaxRobots> reported_;  // of states
  std::vector<Waiting> waiting_;
  std::vector<Delivery> delivered_;
  bool published_ = false;
  std::optional<TimeNs> began_;
  std::uint32_t known_at_base_ = 0;
  std::uint16_t sequence_ = 0;
  TimeNs next_news_ = 0, all_states_due_ = 0, last_send_ = 0;
  bool hurried_ = false;
  double allowance_bytes_;
  RobotId next_reported_ = 0;  // whose state it forwards next
  GossipCounts counts_;
};

}  // namespace karst::core
