// The frontiers that the policy may choose from, each with a viewpoint and the path length to it.
//
// It runs on the map lane.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core_stack/mission/decision/goal_ledger.h"
#include "core_stack/mission/decision/viewpoints.h"
#include "core_stack/mission/policy/policy_port.h"
#include "core_stack/mission/world_model/team_membership.h"
#include "core_stack/mission/world_model/world_model.h"

namespace karst::core {

/// A frontier that no sensor of the vehicle sees from any reachable place.
struct UnseenFrontier {
  std::uint32_t id = 0;
  Vec3 position = Vec3::Zero();
  std::string reason;
};

struct OfferQuery {
  const ClearanceRoadmap* roadmap = nullptr;  // up to date; viewpoints have its clearance
  Vec3 from = Vec3::Zero();                   // where a new path would begin
  TimeNs now = 0;
  std::optional<std::uint32_t> leave_out;  // a frontier that will have been seen by then
  Claims claims;                           // of other vehicles
};

struct Offers {
  std::vector<FrontierOffer> frontiers;  // by id; they point to the world's clusters
  ClosureRules rules;                    // for checking the policy's goals
};

bool any_reachable(const std::vector<FrontierOffer>& offers);

class FrontierOffers {
 public:
  /// `world` and `ledger` must outlive it.
  FrontierOffers(const CoreOptions& options, const VehicleDescription& vehicle, const WorldModel& world,
                 const GoalLedger& ledger);

  /// The open frontiers with an open viewpoint. If none of them can be reached, those claimed by other
  /// vehicles, too; failing that, those whose closure has not expired; failing that, those that can only be
  /// looked at from a distance, because space not yet seen blocks the way to them.
  Offers find(const OfferQuery& query);

  /// The frontiers that find() left out because no sensor of the vehicle sees them. Each is returned once in
  /// a flight.
  std::vector<UnseenFrontier> take_unseen();

 private:
  struct KnownViewpoint {
    std::uint64_t revision;  // of the map near the cluster
    std::vector<CellKey> cells;
    std::optional<Viewpoint> viewpoint;
  };
  using Viewpoints = std::map<std::uint32_t, KnownViewpoint>;  // by frontier

  std::vector<FrontierOffer> find_by(const ClosureRules& rules, const Claims& claims,
                                     const OfferQuery& query);
  std::vector<FrontierOffer> find_distant(const ClosureRules& rules, const OfferQuery& query) const;
  void measure_paths(std::vector<FrontierOffer>& offers, const OfferQuery& query) const;
  KnownViewpoint viewpoint_for(const FrontierCluster& cluster, const ClearanceRoadmap& roadmap);
  Viewpoints& known(Passages passages) {
    return passages == Passages::narrow ? narrow_viewpoints_ : usual_viewpoints_;
  }
  void explain_unseen(const FrontierCluster& cluster, double clearance_m);

  std::int64_t min_open_cells_;
  VehicleDescription vehicle_;
  const WorldModel* world_;
  const GoalLedger* ledger_;
  Viewpoints usual_viewpoints_, narrow_viewpoints_;
  std::set<std::uint32_t> explained_;   // in this flight
  std::vector<UnseenFrontier> unseen_;  // yet to be returned
};

}  // namespace karst::core
