// Mission control's interface to the team. Times are the vehicle's own; team time is ahead of them by the
// moment at which the vehicle was switched on.
#pragma once
#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core_stack/team/relay_homing.h"
#include "core_stack/team/right_of_way/seen_vehicles.h"

namespace karst::core {

/// The drop of a communication node: released at about `from`, it should come to rest on `ground`.
struct NodeDrop {
  Vec3 from = Vec3::Zero(), ground = Vec3::Zero();
};

class Teamwork {
 public:
  Teamwork(TeamNode& node, RelayHoming& homing, const TeamOptions& options, TimeNs ahead)
      : node_(&node), homing_(&homing), options_(options), ahead_(ahead) {}

  /// Use on the map lane only.
  RelayHoming* homing() const { return homing_; }
  const TeamOptions& options() const { return options_; }
  bool lands_as_relay() const { return options_.strategy != LandingStrategy::return_to_base; }
  RobotId self() const { return node_->self(); }
  TimeNs team_time(TimeNs own) const { return own + ahead_; }

  void report(TeamState state, TimeNs now) {
    state.stamp = team_time(now);
    node_->set_state(state);
  }
  /// What was received since the last call.
  TeamNews take_news(TimeNs now, double seconds_left) {
    return {team_time(now),
            node_->take_facts(),
            node_->relays(),
            node_->taken_ground(),
            node_->claimed_goals(team_time(now)),
            team_time(now) + from_seconds(seconds_left)};
  }
  /// Whether that robot is on its way to a claimed landing site and its battery has not run out.
  bool lands_soon(RobotId robot, TimeNs now) const {
    const std::vector<Relay> relays = node_->relays();
    return std::any_of(relays.begin(), relays.end(), [&](const Relay& r) {
      return r.robot == robot && r.stands_by && *r.stands_by > team_time(now);
    });
  }
  std::uint32_t publish(const Record& record) { return node_->publish(record); }
  /// How many of this robot's records the base is known to hold.
  std::uint32_t known_at_base() const { return node_->gossip().known_at_base(); }
  std::vector<TeamObject> objects() const { return merged(node_->objects()); }
  bool base_in_contact(TimeNs now, TimeNs since) const {
    return node_->base_in_contact(team_time(now), team_time(since));
  }
  void drop_node(const NodeDrop& drop) { drop_ = drop; }
  /// The drop requested since the last call.
  std::optional<NodeDrop> take_drop() { return std::exchange(drop_, std::nullopt); }
  bool overruled() const { return node_->overruled(); }
  /// The others' last received states, by this vehicle's clock.
  std::vector<TeammateState> teammates(TimeNs now) const {
    std::vector<TeammateState> all = node_->teammates(team_time(now));
    for (TeammateState& m : all) m.heard -= ahead_;
    return all;
  }
  /// What was seen in the air at `stamp`.
  void note_seen(std::span<const Vec3> bodies, TimeNs stamp) {
    seen_.note(bodies, stamp, node_->neighbours(team_time(stamp)));
  }
  /// Those heard not longer ago than `oldest`, even if by now they are elsewhere.
  std::vector<Neighbour> heard(TimeNs now, TimeNs oldest) const {
    return node_->neighbours(team_time(now), oldest);
  }
  bool may_meet_unheard(TimeNs now) const { return node_->may_meet_unheard(team_time(now)); }
  /// Other vehicles in the air: those heard, and those that are only seen.
  std::vector<Neighbour> neighbours(TimeNs now) const {
    std::vector<Neighbour> all = node_->neighbours(team_time(now));
    const std::vector<Neighbour> seen = seen_.neighbours(now);
    all.insert(all.end(), seen.begin(), seen.end());
    return all;
  }

 private:
  TeamNode* node_;
  RelayHoming* homing_;
  TeamOptions options_;
  TimeNs ahead_;
  std::optional<NodeDrop> drop_;
  SeenVehicles seen_;
};

}  // namespace karst::core
