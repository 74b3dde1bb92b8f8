// Everything that works on the map: it takes in rays, asks the policy, checks its goals, and plans.
//
// An Explorer lives on the map lane of the executive: all its calls run there one after another, so the map
// needs no lock and a decision sees the map as it was when the decision began.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core_stack/homing/relay_homing.h"
#include "core_stack/homing/waiting_place.h"
#include "core_stack/mapping/frontiers.h"
#include "core_stack/mission/fallback_policy.h"
#include "core_stack/mission/goal_ledger.h"
#include "core_stack/mission/mission_options.h"
#include "core_stack/mission/output_budget.h"
#include "core_stack/mission/policy_port.h"
#include "core_stack/mission/reach.h"
#include "core_stack/mission/visibility.h"

namespace karst::core {

/// What one round of decision starts from.
struct RoundInput {
  TimeNs now = 0, deadline = 0;
  State state;               // expected at the deadline
  Vec3 from = Vec3::Zero();  // where the new path begins: the end of the stretch already committed to
  Vec3 direction = Vec3::UnitX();
  double seconds_left = 0;     // of flight, by the battery and by the mission's time limit
  double way_come_m = 0;       // length of the way flown so far: the way home where the map shows none
  std::vector<Vec3> way_come;  // all of it, up to `from`
  GoalFate last_fate = GoalFate::none;
  std::optional<Goal> last_goal;
  bool standing = false;                 // nothing is under way
  bool appending = false;                // the last goal will be reached before the new one is flown to
  std::vector<PolicyEvent> events;       // since the last round
  std::vector<HeardMate> mates;          // the others of a team
  std::vector<std::uint32_t> looked_at;  // frontiers reached, or seen on the way, since the last round
};

struct RejectedGoal {
  Goal goal;
  std::string reason;
};

/// A frontier that no sensor of the vehicle could see from where it could fly to.
struct UnseenFrontier {
  std::uint32_t id = 0;
  Vec3 position = Vec3::Zero();
  std::string reason;
};

struct RoundResult {
  Outcome outcome = Outcome::hold;
  bool out_of_time = false;  // that is why nothing is left to explore
  std::string reason, policy;
  std::optional<Goal> goal;  // accepted, with `path` from RoundInput::from to it
  Path path;
  std::vector<RejectedGoal> rejected;
  std::vector<UnseenFrontier> unseen;  // for the first time in this round
  std::vector<Drawing> drawings;
  std::vector<std::string> drawing_texts;  // the same as fields of events, made by mission control
  std::vector<std::string> log;
  std::string policy_failure;  // if it failed in this round: the fallback takes over
  std::size_t goals_proposed = 0;
  std::vector<FrontierCluster> frontiers;  // as offered, without their cells: for the report
  double decide_ms = 0, plan_ms = 0;       // wall clock, for timing.json only
};

struct HomeEstimate {
  double length_m = 0, time_s = 0;
};

class Explorer {
 public:
  Explorer(const CoreOptions& options, const VehicleDescription& vehicle, PolicyPort& policy);

  /// Takes one sensor's rays into the map; returns what changed.
  std::vector<CellChange> integrate(const std::vector<Ray>& rays);
  std::vector<CellChange> declare_launch_site(const Vec3& hover_point);

  /// A picture was taken from there, by the vehicle's colour camera.
  void note_picture(const Pose& T_world_camera);

  RoundResult decide(const RoundInput& input);
  /// A way from `from` to `to` for going home or around a new obstacle.
  Path plan_to(const Vec3& from, const Vec3& to);
  /// Through the map, or if no way is known there, `way_come_m` long.
  HomeEstimate estimate_home(const Vec3& from, double way_come_m);
  /// Back along poses flown, from the last to the first, leaving out loops where the map shows a clear line.
  std::vector<Vec3> way_back(const std::vector<Vec3>& flown) const;
  /// What happened to its goals, and that it is over.
  void tell(const std::vector<PolicyEvent>& events, TimeNs now);
  /// Index of the first segment of `points` nearer to an obstacle's cell than the vehicle's radius, or -1.
  int touching_segment(const std::vector<Vec3>& points) const;
  /// Index of the first segment of `points` that the map now forbids, or -1. Near the `narrow_places` of the
  /// path it allows for less clearance.
  int blocked_segment(const std::vector<Vec3>& points, const std::vector<Vec3>& narrow_places) const;
  /// Distance of the vehicle's hull at `p` from the nearest obstacle's cell; nothing if that is far.
  std::optional<double> hull_clearance_m(const Vec3& p) const;
  /// Where to hover between the place it stood at and `highest`, straight above: as high as the usual
  /// clearance allows, and without so much room where there is most of it above and below.
  Vec3 hover_below(const Vec3& highest) const;
  /// True if the cluster is still open enough to be worth flying to.
  bool cluster_alive(std::uint32_t id) const;

  // In a team.
  void join(RelayHoming* homing, double claim_radius_m) {
    homing_ = homing;
    claim_radius_m_ = claim_radius_m;
  }
  /// Takes in what was heard; returns what to tell.
  TreeFacts share(const Vec3& here, const TeamNews& news);
  /// See RelayHoming::reach_ends.
  std::optional<Vec3> reach_ends(const Release& here, const Release& ahead) const {
    return homing_->reach_ends(map_, here, ahead);
  }
  /// Where to land as a relay, if that takes less time than the way to the start.
  std::optional<LandingSpot> landing_spot(const Vec3& from, double way_come_m);
  /// It landed below `hover`: what to tell.
  TreeFacts land(const Vec3& hover, TimeNs team_time);
  /// Where it makes room for another vehicle; the vehicle's radius is filled in.
  std::optional<Refuge> refuge(RoomQuery query);

  const VoxelMap& map() const { return map_; }
  const Vec3& home() const { return home_; }
  /// Where the vehicle came to hover, if take-off had to stop lower than planned.
  void set_home(const Vec3& hover_point) { home_ = hover_point; }

 private:
  HomeEstimate estimate_base(const Vec3& from, double way_come_m);
  std::optional<LandingSpot> nearest_spot(const Vec3& from, double sooner_than_s);
  double slow_mps() const;  // in narrow passages
  bool left_to_others(const Vec3& frontier) const;
  OtherVehicle seen_by_policy(const HeardMate& mate, TimeNs now) const;
  std::vector<CellChange> take_in(std::vector<CellChange> changes);
  Reach& wide();
  Reach* narrow();
  Reach& reach_at(const Vec3& from);
  Path plan_in(const Reach& reach, const Vec3& from, const Vec3& to) const;
  double narrow_length_m(const Path& way) const;
  std::vector<FrontierOffer> offers(Reach& reach, const RoundInput& input);
  std::vector<FrontierOffer> offers_now(Reach& reach, const RoundInput& input);
  void explain_unseen(const Reach& reach, const FrontierCluster& cluster);
  DecisionRequest request(const Reach& reach, const RoundInput& input);
  void settle(const Reach& reach, const RoundInput& input, const DecisionRequest& request, bool passed_over,
              RoundResult& result);
  Decision ask(const DecisionRequest& request, bool passed_over, RoundResult& result);
  std::optional<std::string> objection(const Reach& reach, const Goal& goal) const;
  bool choose(const Reach& reach, const RoundInput& input, const std::vector<Goal>& goals,
              RoundResult& result);

  CoreOptions options_;
  VehicleDescription vehicle_;
  SteepestView view_;
  PolicyPort* policy_;
  FallbackPolicy fallback_;
  bool policy_failed_ = false;
  std::optional<TimeNs> idle_since_;  // standing, and no goal of the policy could be accepted
  std::uint32_t sequence_ = 0;
  OutputBudget output_budget_;

  VoxelMap map_;
  Frontiers frontiers_;
  ImagedSurface imaged_;
  Reach wide_;
  std::optional<double> narrow_clearance_m_;  // if narrow passages may be flown
  std::optional<Reach> narrow_;               // made when it is first needed
  GoalLedger ledger_;
  TimeNs closed_at_ = 0;         // the time at which places are judged closed in this round
  bool by_pause_alone_ = false;  // and how
  std::set<std::uint32_t> explained_unseen_;
  std::vector<UnseenFrontier> unseen_;  // yet to be told
  struct Chosen {
    std::size_t cells;
    Vec3 centroid;
  };
  std::map<std::uint32_t, Chosen> chosen_;  // clusters as they were when a goal was accepted for them
  Vec3 home_;

  RelayHoming* homing_ = nullptr;  // null: it flies alone
  double claim_radius_m_ = 0;
  bool claims_waived_ = false;   // in this round: nothing else is left
  std::vector<CellKey> closed_;  // cells that became rock since the team was last told
};

}  // namespace karst::core
