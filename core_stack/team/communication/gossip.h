// Store and forward: every robot comes to hold every record of every robot, over links that lose, corrupt and
// come and go.
//
// Each robot says every period what it holds (a version vector) and how it is; three times as often while
// those around it do not hold the same, and while another flies near. Who hears that the other lacks
// something it holds itself sends it (anti-entropy; Demers et al., Epidemic Algorithms for Replicated
// Database Maintenance, 1987). Records are forwarded by whoever first hears them, after a random wait, unless
// by then another was heard to send it or all in contact are known to hold it: the radio is heard by all
// around, and one of several neighbours is enough. Nothing is assumed about contact: a robot that was away
// for an hour is brought up to date by the first it meets. What is heard says how good links are: the gaps in
// the numbers of a robot's frames. A frame counts once, and soon after it was sent (replay_window.h); what it
// says counts if it can be true (plausible.h).
#pragma once
#include <array>
#include <optional>

#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/team/communication/plausible.h"
#include "core_stack/team/communication/record_store.h"
#include "core_stack/team/communication/replay_window.h"

namespace karst::core {

constexpr std::size_t kFewRadios = 8;  // others whose states one frame a period tells often enough
/// Of many in a chain the oldest state was 0.9 to 1.7 periods a radio old.
constexpr double kPeriodsPerRadio = 1.8;

struct GossipOptions {
  double period_s = 1.0;      // of telling its state and what it holds
  double bytes_per_s = 1120;  // of its own frames, as a mean; a burst may be ten frames
  double contact_age_s =
      5.0;  // a robot not heard for longer is out of contact, a frame older than that stale
  std::int64_t max_records = 20000;  // of one robot
};
void describe(OptionTable& t, GossipOptions& o);

struct GossipCounts {
  std::uint64_t frames_sent = 0, bytes_sent = 0, frames_heard = 0, bytes_heard = 0;
  std::array<std::uint64_t, kRefusals> refused{};  // frames, by Refusal
  std::uint64_t records_refused = 0;  // in good frames: no record, not plausible, too far ahead, too many
  std::uint64_t states_refused = 0;   // not plausible
  std::uint64_t claims_refused = 0;   // that somebody holds more of its records than there are
  std::uint64_t contradictions = 0;   // another text under a number that is known
  std::uint64_t records_taken = 0, records_again = 0;
};

struct Delivery {
  RobotId author = 0;
  std::uint32_t number = 0;
  Record record;
};

class Gossip {
 public:
  /// `seed` is for waits only.
  Gossip(const TeamRadio& radio, const GossipOptions& options, std::uint64_t seed);

  /// A new record of its own; tree facts are split. Returns the number of the last record made of it, 0 if it
  /// cannot be written or there is no room for it.
  std::uint32_t publish(const Record& record);
  /// How it is, to be told with the next frame; robot and heard are filled in.
  void set_state(const TeamState& state) { state_ = state; }
  /// Tells its state more often: another vehicle is near.
  void hurry(bool near) { hurried_ = near; }

  /// Bytes from the radio.
  void receive(std::span<const std::uint8_t> bytes, TimeNs now);
  /// Frames to send now; to be called often (ten times a second), `now` never going back.
  std::vector<Bytes> send(TimeNs now);

  /// Records of others since the last call, each once, in the order they arrived.
  std::vector<Delivery> take_delivered();
  /// The newest state known of each robot, its own left out, by robot.
  std::vector<TeamState> states() const;
  /// Its own as last told, with whom it heard: what a relay graph is to note beside the others'.
  const TeamState& reported_state() const { return state_; }
  /// Robots heard of late, and not before `since`, with the share of frames that arrived.
  std::vector<RadioContact> contacts(TimeNs now, TimeNs since) const;

  /// What it holds, to be published: by the base, whenever something arrived that its finder waits for.
  Receipt receipt() const;
  const HeldNumbers& held(RobotId author) const { return store_.held(author); }
  /// How many of its own records the base is known to hold, counted from the first, by what the base itself
  /// said when heard or by its receipts.
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
  RobotId next_reported_ = 0;  // whose state is passed on next
  GossipCounts counts_;
};

}  // namespace karst::core
