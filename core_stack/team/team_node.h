// One robot among the others, or the base: what it says over the radio, and what it knows of the team by what
// it heard. All times are the team's.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core_stack/team/right_of_way/separation.h"
#include "core_stack/team/team_objects.h"
#include "core_stack/team/team_options.h"

namespace karst::core {

/// For so long a position told is one to keep apart from.
constexpr TimeNs kNewsHold = 3 * kSecond;

/// A communication node as a robot knows it.
struct Relay {
  RobotId robot = 0;
  Vec3 antenna = Vec3::Zero(), hover = Vec3::Zero();
  std::optional<TimeNs> stands_by{};  // it is yet to land there: then its battery ends
};

/// Another robot as it was last heard of.
struct TeammateState {
  RobotId robot = 0;
  TimeNs heard = 0;  // when this was true
  Vec3 position = Vec3::Zero(), velocity_mps = Vec3::Zero();
  std::optional<Vec3> goal;  // claimed, if it explores
  bool explores = false;
  double seconds_left = 0;  // of its battery, then
};

class TeamNode {
 public:
  /// `base` is the base's antenna; the seed is for waits only.
  TeamNode(RobotId self, const TeamOptions& team, const HomingOptions& homing, const Vec3& base,
           std::uint64_t seed, const MissionKey& key);

  // The radio.
  void receive(std::span<const std::uint8_t> bytes, TimeNs now);
  /// Frames to send now; to be called ten times a second.
  std::vector<Bytes> transmit(TimeNs now);

  // What it has to say.
  void set_state(const TeamState& state) { gossip_.set_state(state); }
  /// Returns the record's number, 0 if it could not be written.
  std::uint32_t publish(const Record& record);

  // What it knows.
  /// Communication nodes that reached the base when last heard of, and are not told dead; the base first, and
  /// last those that have claimed a place and are on the way there.
  std::vector<Relay> relays() const;
  /// It hears somebody who reaches the base well enough to land by; not before `since` the last time.
  bool base_in_contact(TimeNs now, TimeNs since) const;
  /// Vehicles in the air that were heard of not longer ago than `oldest`, where they should be by now.
  std::vector<Neighbour> neighbours(TimeNs now, TimeNs oldest = kNewsHold) const;
  /// A robot may fly that was not heard lately, and was not on the ground when it was heard the last time.
  bool may_meet_unheard(TimeNs now) const;
  /// All robots that have started and were ever heard of, by number.
  std::vector<TeammateState> teammates(TimeNs now) const;
  /// Others' goals that are still claimed.
  std::vector<Vec3> claimed_goals(TimeNs now) const;
  /// Where others stand, or are about to land. Of two that claim one place the earlier claim holds.
  std::vector<Vec3> taken_ground() const;
  /// Its own claim was made later than another's of nearly the same place.
  bool overruled() const;
  /// Facts of the homing tree that others told since the last call; the base's own too.
  TreeFacts take_facts();
  /// Objects of interest as their finders last told of them, its own among them.
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
  std::array<std::optional<NodeId>, kMaxRobots> nodes_;  // of robots that landed
  std::array<std::optional<LifeFact>, kMaxRobots> lives_;
  std::array<std::optional<TimeNs>, kMaxRobots> heard_at_;  // since it landed itself
  std::array<bool, kMaxRobots> silent_{};                   // since then
  TimeNs receipt_due_ = 0;
  bool news_for_receipt_ = false;
};

}  // namespace karst::core
