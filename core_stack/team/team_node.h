// One node of the team, a robot or the base: what it transmits, and what it knows of the team from what it
// received. All times are team time.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core_stack/team/right_of_way/separation.h"
#include "core_stack/team/team_objects.h"
#include "core_stack/team/team_options.h"

namespace karst::core {

/// For so long after it was reported a position is kept apart from.
constexpr TimeNs kNewsHold = 3 * kSecond;

/// A communication node as a robot knows it.
struct Relay {
  RobotId robot = 0;
  Vec3 antenna = Vec3::Zero(), hover = Vec3::Zero();
  std::optional<TimeNs> stands_by{};  // set if it has yet to land there: when its battery ends
};

/// Another robot's state as last received.
struct TeammateState {
  RobotId robot = 0;
  TimeNs heard = 0;  // time of this state
  Vec3 position = Vec3::Zero(), velocity_mps = Vec3::Zero();
  std::optional<Vec3> goal;  // claimed, if it explores
  bool explores = false;
  double seconds_left = 0;  // of battery at that time
};

class TeamNode {
 public:
  /// `base` is the base's antenna. The seed only randomizes waits.
  TeamNode(RobotId self, const TeamOptions& team, const HomingOptions& homing, const Vec3& base,
           std::uint64_t seed, const MissionKey& key);

  // The radio.
  void receive(std::span<const std::uint8_t> bytes, TimeNs now);
  /// Returns the frames to send now. Call it ten times a second.
  std::vector<Bytes> transmit(TimeNs now);

  // What it publishes.
  void set_state(const TeamState& state) { gossip_.set_state(state); }
  /// Returns the record's number, or 0 if the record could not be written.
  std::uint32_t publish(const Record& record);

  // What it knows.
  /// Communication nodes that had a route to the base when last heard and are not reported dead. The base
  /// comes first, robots on their way to a claimed landing site come last.
  std::vector<Relay> relays() const;
  /// Whether since `since` it has heard a node whose link to the base is good enough for a relay landing.
  bool base_in_contact(TimeNs now, TimeNs since) const;
  /// Vehicles in the air that were heard of not longer ago than `oldest`, where they should be by now.
  std::vector<Neighbour> neighbours(TimeNs now, TimeNs oldest = kNewsHold) const;
  /// Whether a robot that was not heard lately may be in the air: it had not landed when it was last heard.
  bool may_meet_unheard(TimeNs now) const;
  /// All robots that have started and were ever heard of, by number.
  std::vector<TeammateState> teammates(TimeNs now) const;
  /// Goals that other robots currently claim.
  std::vector<Vec3> claimed_goals(TimeNs now) const;
  /// Ground where other robots stand or are about to land. If two robots claim a site, the earlier claim
  /// holds.
  std::vector<Vec3> taken_ground() const;
  /// Whether another robot claimed nearly the same site before this one did.
  bool overruled() const;
  /// Facts of the homing tree received since the last call, the base's own included.
  TreeFacts take_facts();
  /// Objects of interest as last reported by their finders, its own included.
  const ReportedObjects& objects() const { return objects_; }

  const Gossip& gossip() const { return gossip_; }
  const RelayGraph& graph() const { return graph_; }
  const std::optional<LandingClaim>& landing_of(RobotId robot) const { return landings_[robot]; }
  bool reported_dead(RobotId robot) const { return lives_[robot] && !lives_[robot]->alive; }
  RobotId self() const { return gossip_.self(); }

 private:
  RelayGraph::Robots landed() const;
  RelayGraph::Robots landed_in_range() const;
  bool claims_goal(RobotId robot, TimeNs now) const;
  void take(const Delivery& delivery);
  void note_facts(const TreeFacts& facts);
  void watch_relays(TimeNs now);

  TeamOptions team_;
  double link_age_s_, landing_separation_m_;
  Relay base_;
  Gossip gossip_;
  RelayGraph graph_;
  TreeFacts facts_;
  ReportedObjects objects_;
  std::array<std::optional<GoalClaim>, kMaxRobots> goals_;
  std::array<std::optional<LandingClaim>, kMaxRobots> landings_;
  std::array<std::optional<NodeId>, kMaxRobots> nodes_;  // of landed robots
  std::array<std::optional<LifeFact>, kMaxRobots> lives_;
  std::array<std::optional<TimeNs>, kMaxRobots> heard_at_;  // since it landed itself
  std::array<bool, kMaxRobots> silent_{};                   // since then
  TimeNs receipt_due_ = 0;
  bool news_for_receipt_ = false;
};

}  // namespace karst::core
