// Where a robot would land as a relay, and how long it takes to come to the ground there: asked every second
// and for every goal, by the strategy of the mission.
//
// relay_tree (the paper): along the homing tree to the nearest communication node, and down where that node
// comes into reach. relay_chain: to the nearest of all landing places it knows, of whichever node. Places are
// judged while it flies by, every few metres. It also counts on robots that are on their way down and have
// claimed a place, if their batteries end before its own.
//
// It lives where the map lives, on the map lane.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core_stack/planning/roadmap/roadmap.h"
#include "core_stack/planning/trajectory/trajectory.h"
#include "core_stack/team/team_node.h"
#include "core_stack/team/team_options.h"

namespace karst::core {

/// Where to come down. `time_s` is flight, a moment to hear whether it is in contact there, and descent.
struct LandingSpot {
  Vec3 hover = Vec3::Zero(), ground = Vec3::Zero();  // straight below
  RobotId node = kBase;                              // that it counts on
  bool claimed = false;                              // the node is yet to land there
  double length_m = 0, time_s = 0;
};

/// Of a node that is dropped: it goes on with the vehicle's speed.
struct Release {
  Vec3 position = Vec3::Zero(), velocity_mps = Vec3::Zero();
};

/// What a robot heard since the last time.
struct TeamNews {
  TimeNs stamp = 0;  // the team's time
  TreeFacts facts;
  std::vector<Relay> relays;
  std::vector<Vec3> taken;  // ground that others stand on or claim
  std::vector<Vec3> goals;  // that others claim
  TimeNs ends = 0;          // its own battery, by the team's clock
};

struct RelayHomingSetup {
  TeamOptions team;  // strategy return_to_base keeps the tree for the others, and knows no places
  HomingOptions homing;
  PlanningOptions planning;
  MotionLimits motion;
  double vehicle_radius_m = 0;
  Vec3 base = Vec3::Zero();  // the base's antenna
};

class RelayHoming {
 public:
  RelayHoming(RobotId self, const RelayHomingSetup& setup);

  /// Takes in what others told and what it has seen since: a pose node at `here`, rays near cells in `closed`
  /// that became rock. The roadmap must be up to date. Returns what to tell the others.
  TreeFacts update(const VoxelMap& map, const Roadmap& roadmap, const Vec3& here, const TeamNews& news,
                   std::span<const CellKey> closed);

  /// Judges the ground of the last poses and of `here` too, as far as it has been seen: when a place is
  /// needed now.
  void look_around(const VoxelMap& map, const Roadmap& roadmap, const Vec3& here);
  /// The place by the strategy that takes the least time from `from`, if that is less than `sooner_than_s`.
  std::optional<LandingSpot> spot_from(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from,
                                       double sooner_than_s) const;
  /// Never again to this place: it was tried in vain.
  void give_up(const Vec3& hover) { given_up_.push_back(hover); }
  /// Nobody was heard there. The map promises more of that node's link than there is; and one that should
  /// have landed by now has not, or not there. Links are to be found anew: update() or look_around().
  void no_contact_at(const LandingSpot& spot);

  /// Where a communication node that is dropped `here` would come to lie, if by the map a relay is in reach
  /// of it there, and none would be of one dropped `ahead`.
  std::optional<Vec3> relay_drop_site(const VoxelMap& map, const Release& here, const Release& ahead) const;

  /// It has landed: its communication node, above where it stands.
  TreeFacts land(const VoxelMap& map, const Roadmap& roadmap, const Vec3& hover, TimeNs stamp);

  const HomingTree& tree() const { return tree_; }
  const std::vector<Vec3>& others_goals() const { return goals_; }
  std::size_t places() const { return sites_.size(); }

 private:
  struct LandingSite {
    Vec3 hover, ground;
    std::optional<RobotId> node;  // in reach by the map
    bool claimed = false;
  };

  void judge(const VoxelMap& map, const Roadmap& roadmap, const Vec3& pose);
  void find_links(const VoxelMap& map);
  bool has_failed(const Relay& relay) const;
  bool free_to_take(const LandingSite& site) const;
  std::optional<LandingSpot> nearest_place(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from,
                                           double sooner_than_s) const;
  std::optional<LandingSpot> up_the_tree(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from) const;
  double down_s(const LandingSite& site) const;
  /// To spare of the link between who stands on `ground` and a relay, as far as the map tells.
  double margin_db(const VoxelMap& map, const Vec3& ground, const Relay& to) const;

  RobotId self_;
  LandingStrategy strategy_;
  HomingOptions options_;
  PlanningOptions planning_;
  MotionLimits limits_;
  double radius_m_, separation_m_;
  HomingTree tree_;
  std::uint32_t nodes_made_ = 0;
  std::vector<Vec3> passed_;    // poses whose ground is judged, or will be
  std::vector<Vec3> to_judge_;  // of these, yet to be seen from farther on
  std::vector<LandingSite> sites_;
  std::vector<Vec3> given_up_;
  std::array<double, kMaxRobots> doubt_db_{};                      // of each node's links
  std::array<std::optional<Vec3>, kMaxRobots> failed_antennas_{};  // antennas, where they were to stand
  std::vector<Relay> relays_;
  std::vector<Vec3> taken_, goals_;
};

}  // namespace karst::core
