// Chooses where a robot lands as a relay, and estimates how long it takes to land there. It is asked every
// second and for every goal. The mission's strategy decides:
//
// relay_tree (the paper): fly along the homing tree to the nearest communication node and land where that
// node comes into range. relay_chain: fly to the nearest of all known landing sites, whichever node it links
// to. The robot judges sites every few metres as it flies past. It also counts on robots that are descending
// to a claimed site, if their batteries run out before its own.
//
// This class runs on the map lane.
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

/// A landing site. `time_s` covers the flight, a moment to check for radio contact there, and the descent.
struct LandingSpot {
  Vec3 hover = Vec3::Zero(), ground = Vec3::Zero();  // straight below
  RobotId node = kBase;                              // that it links to
  bool claimed = false;                              // the node is yet to land there
  double length_m = 0, time_s = 0;
};

/// The state in which a node is dropped: it keeps the vehicle's velocity.
struct Release {
  Vec3 position = Vec3::Zero(), velocity_mps = Vec3::Zero();
};

/// What a robot received since the last update.
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

  /// Updates the tree with the reports of other robots and with the robot's own observations: adds a pose
  /// node at `here` and checks rays near the cells in `closed`, which became occupied. The roadmap must be up
  /// to date. Returns the facts to publish.
  TreeFacts update(const VoxelMap& map, const Roadmap& roadmap, const Vec3& here, const TeamNews& news,
                   std::span<const CellKey> closed);

  /// Judges the ground below the last poses and below `here` at once, as far as it has been observed. For
  /// when a landing site is needed now.
  void look_around(const VoxelMap& map, const Roadmap& roadmap, const Vec3& here);
  /// The site, by the mission's strategy, that takes the least time from `from`, if below `sooner_than_s`.
  std::optional<LandingSpot> spot_from(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from,
                                       double sooner_than_s) const;
  /// Blacklists this site: an attempt to land there failed.
  void give_up(const Vec3& hover) { given_up_.push_back(hover); }
  /// Reports that the robot had no radio contact at the site. The link to its node is worse than the map
  /// predicts, or the expected relay has not landed there. Call update() or look_around() to find new links.
  void no_contact_at(const LandingSpot& spot);

  /// Where a communication node dropped `here` would come to rest, if the map predicts that it is in range of
  /// a relay and that a node dropped `ahead` would not be.
  std::optional<Vec3> relay_drop_site(const VoxelMap& map, const Release& here, const Release& ahead) const;

  /// Reports the landing: returns its communication node, above where it stands.
  TreeFacts land(const VoxelMap& map, const Roadmap& roadmap, const Vec3& hover, TimeNs stamp);

  const HomingTree& tree() const { return tree_; }
  const std::vector<Vec3>& others_goals() const { return goals_; }
  std::size_t places() const { return sites_.size(); }

 private:
  struct LandingSite {
    Vec3 hover, ground;
    std::optional<RobotId> node;  // predicted in range by the map
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
  /// Link margin between a vehicle on `ground` and a relay, predicted from the map.
  double margin_db(const VoxelMap& map, const Vec3& ground, const Relay& to) const;

  RobotId self_;
  LandingStrategy strategy_;
  HomingOptions options_;
  PlanningOptions planning_;
  MotionLimits limits_;
  double radius_m_, separation_m_;
  HomingTree tree_;
  std::uint32_t nodes_made_ = 0;
  std::vector<Vec3> passed_;    // poses whose ground has been judged, or will be
  std::vector<Vec3> to_judge_;  // those to be observed from farther on first
  std::vector<LandingSite> sites_;
  std::vector<Vec3> given_up_;
  std::array<double, kMaxRobots> doubt_db_{};                      // of each node's links
  std::array<std::optional<Vec3>, kMaxRobots> failed_antennas_{};  // of expected relays that never answered
  std::vector<Relay> relays_;
  std::vector<Vec3> taken_, goals_;
};

}  // namespace karst::core
