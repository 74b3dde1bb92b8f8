// The frontiers a policy may choose from, each with a viewpoint and the length of the way there.
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core_stack/mission/explorer.h"

namespace karst::core {
namespace {

/// Viewpoints are looked for as far as this from a cluster, and so far matters what the map holds there.
constexpr double kViewpointReach_m = 4.6;

/// Pauses of places tried in vain that are waived when no other place is left: the first three attempts'.
constexpr TimeNs kPauseWaived = 40 * kSecond;
/// In a narrow passage the next place to look at is never far from the last ones: two more, even if nothing
/// has changed there.
constexpr TimeNs kNarrowPauseWaived = 160 * kSecond;

}  // namespace

/// A vehicle that saw in all directions might look into it: then it is the sensors that forbid it.
void Explorer::explain_unseen(const Reach& reach, const FrontierCluster& cluster) {
  auto sphere = std::make_shared<LidarModel>();
  sphere->elevation_rad = {std::numbers::pi_v<float> / 2, -std::numbers::pi_v<float> / 2};
  VehicleDescription all_seeing = vehicle_;
  all_seeing.lidar = sphere;
  const auto from = find_viewpoint(map_, cluster, all_seeing, reach.planning.clearance_m);
  if (!from) return;
  explained_unseen_.insert(cluster.id);
  const double rise_m = cluster.centroid.z() - from->position.z();
  const std::string where = std::abs(rise_m) < map_.resolution_m() ? "beside"
                            : rise_m > 0                           ? "above"
                                                                   : "below";
  unseen_.push_back(
      {cluster.id, cluster.centroid,
       "no sensor of the vehicle sees what lies " + where + " it there, and it flies into nothing unseen"});
}

std::vector<FrontierOffer> Explorer::offers(Reach& reach, const RoundInput& input) {
  std::vector<FrontierOffer> open;
  std::map<std::uint32_t, KnownViewpoint> kept;
  for (const auto& [id, cluster] : frontiers_.clusters()) {
    if (ledger_.closed(map_, cluster.centroid, closed_at_, by_pause_alone_)) continue;
    if (left_to_others(cluster.centroid)) continue;
    if (input.appending && input.last_goal && input.last_goal->frontier_id == id) continue;
    const std::uint64_t revision = map_.revision_near(cluster.centroid, kViewpointReach_m);
    const auto known = reach.viewpoints.find(id);
    const bool fresh = known != reach.viewpoints.end() && known->second.revision == revision &&
                       known->second.cells == cluster.cells;
    KnownViewpoint entry{revision, cluster.cells, std::nullopt};
    if (fresh) {
      entry.viewpoint = known->second.viewpoint;
    } else if (open_cells(map_, cluster) >= options_.mission.min_open_cells) {
      entry.viewpoint = find_viewpoint(map_, cluster, vehicle_, reach.planning.clearance_m,
                                       &reach == &wide_ ? nullptr : &reach.roadmap);
      if (!entry.viewpoint && !explained_unseen_.contains(id)) explain_unseen(reach, cluster);
    }
    FrontierOffer offer;
    offer.cluster = &cluster;
    offer.path_length_m = std::numeric_limits<double>::infinity();
    if (entry.viewpoint && !ledger_.closed(map_, entry.viewpoint->position, closed_at_, by_pause_alone_)) {
      offer.viewpoint = entry.viewpoint->position;
      offer.viewpoint_heading_rad = entry.viewpoint->heading_rad;
      open.push_back(offer);
    }
    kept.emplace(id, std::move(entry));
  }
  reach.viewpoints = std::move(kept);

  std::vector<Vec3> places;
  for (const FrontierOffer& o : open) places.push_back(o.viewpoint);
  const std::vector<double> lengths = reach.roadmap.distances(map_, input.from, places, map_.resolution_m());
  for (std::size_t i = 0; i < open.size(); ++i) open[i].path_length_m = lengths[i];
  return open;
}

/// If nothing else is left, there is no need to wait with what was tried a few times.
std::vector<FrontierOffer> Explorer::offers_now(Reach& reach, const RoundInput& input) {
  closed_at_ = input.now, by_pause_alone_ = false, claims_waived_ = false;
  std::vector<FrontierOffer> open = offers(reach, input);
  if (!open.empty()) return open;
  if (homing_) {  // rather where another is about to look than nowhere
    claims_waived_ = true;
    open = offers(reach, input);
    if (!open.empty()) return open;
  }
  by_pause_alone_ = &reach != &wide_;
  closed_at_ += by_pause_alone_ ? kNarrowPauseWaived : kPauseWaived;
  return offers(reach, input);
}

}  // namespace karst::core
