#include "core_stack/mission/decision/frontier_offers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace karst::core {
namespace {

/// The search range for viewpoints of a cluster; a viewpoint stays valid until the map changes there.
constexpr double kViewpointRange_m = 4.6;

/// If nothing else is left, the retry pauses of places that failed up to three times are waived.
constexpr TimeNs kPauseWaived = 40 * kSecond;
/// In a narrow passage the next viewpoint is always near the last ones. The retry pauses of two more attempts
/// are waived there, even if the map has not changed.
constexpr TimeNs kNarrowPauseWaived = 160 * kSecond;

ClosureRules last_resort_rules(Passages passages, TimeNs now) {
  if (passages == Passages::narrow) return {.at = now + kNarrowPauseWaived, .ignore_map_change = true};
  return {.at = now + kPauseWaived};
}

}  // namespace

bool any_reachable(const std::vector<FrontierOffer>& offers) {
  return std::any_of(offers.begin(), offers.end(),
                     [](const FrontierOffer& o) { return std::isfinite(o.path_length_m); });
}

FrontierOffers::FrontierOffers(const CoreOptions& options, const VehicleDescription& vehicle,
                               const WorldModel& world, const GoalLedger& ledger)
    : min_open_cells_(options.mission.min_open_cells), vehicle_(vehicle), world_(&world), ledger_(&ledger) {}

Offers FrontierOffers::find(const OfferQuery& query) {
  const ClosureRules now{.at = query.now}, waived = last_resort_rules(query.roadmap->passages(), query.now);
  Offers open{find_by(now, query.claims, query), now};
  if (any_reachable(open.frontiers)) return open;
  // A frontier that another vehicle is about to explore is better than none.
  if (!query.claims.goals.empty())
    if (Offers claimed{find_by(now, {}, query), now}; any_reachable(claimed.frontiers)) return claimed;
  if (Offers closed{find_by(waived, {}, query), waived}; any_reachable(closed.frontiers)) return closed;
  if (Offers distant{find_distant(now, query), now}; any_reachable(distant.frontiers)) return distant;
  return open;
}

std::vector<UnseenFrontier> FrontierOffers::take_unseen() { return std::exchange(unseen_, {}); }

std::vector<FrontierOffer> FrontierOffers::find_by(const ClosureRules& rules, const Claims& claims,
                                                   const OfferQuery& query) {
  const VoxelMap& map = world_->map();
  std::vector<FrontierOffer> open;
  Viewpoints kept;
  for (const auto& [id, cluster] : world_->frontiers().clusters()) {
    if (query.leave_out == id || claims.hold(cluster.centroid) ||
        ledger_->closed(map, cluster.centroid, rules))
      continue;
    const KnownViewpoint& entry = kept.emplace(id, viewpoint_for(cluster, *query.roadmap)).first->second;
    if (!entry.viewpoint || ledger_->closed(map, entry.viewpoint->position, rules)) continue;
    FrontierOffer offer;
    offer.cluster = &cluster;
    offer.viewpoint = entry.viewpoint->position;
    offer.viewpoint_heading_rad = entry.viewpoint->heading_rad;
    open.push_back(offer);
  }
  known(query.roadmap->passages()) = std::move(kept);
  measure_paths(open, query);
  return open;
}

/// Seen from afar through a gap, a passage is known along a cone: wide enough to be worth a look, and nowhere
/// wide enough to fly in. The look from the nearest place that can be flown to widens the cone.
std::vector<FrontierOffer> FrontierOffers::find_distant(const ClosureRules& rules,
                                                        const OfferQuery& query) const {
  const VoxelMap& map = world_->map();
  std::vector<FrontierOffer> out;
  for (const auto& [id, cluster] : world_->frontiers().clusters()) {
    if (query.leave_out == id || open_cells(map, cluster) < min_open_cells_ ||
        ledger_->closed(map, cluster.centroid, rules) ||
        !fits_through(map, cluster, query.roadmap->clearance_m()))
      continue;
    const auto viewpoint = find_distant_viewpoint(map, cluster, vehicle_, *query.roadmap);
    if (!viewpoint || ledger_->closed(map, viewpoint->position, rules)) continue;
    FrontierOffer offer;
    offer.cluster = &cluster;
    offer.viewpoint = viewpoint->position;
    offer.viewpoint_heading_rad = viewpoint->heading_rad;
    out.push_back(offer);
  }
  measure_paths(out, query);
  return out;
}

void FrontierOffers::measure_paths(std::vector<FrontierOffer>& offers, const OfferQuery& query) const {
  const VoxelMap& map = world_->map();
  std::vector<Vec3> viewpoints;
  for (const FrontierOffer& offer : offers) viewpoints.push_back(offer.viewpoint);
  const std::vector<double> lengths =
      query.roadmap->roadmap().distances(map, query.from, viewpoints, map.resolution_m());
  for (std::size_t i = 0; i < offers.size(); ++i) offers[i].path_length_m = lengths[i];
  std::erase_if(offers, [&](const FrontierOffer& o) {
    return std::isfinite(o.path_length_m) && world_->too_far_from_home(*query.roadmap, o.viewpoint);
  });
}

/// Returns the cached viewpoint if nothing has changed near the cluster.
FrontierOffers::KnownViewpoint FrontierOffers::viewpoint_for(const FrontierCluster& cluster,
                                                             const ClearanceRoadmap& roadmap) {
  const VoxelMap& map = world_->map();
  KnownViewpoint entry{map.revision_near(cluster.centroid, kViewpointRange_m), cluster.cells, std::nullopt};
  const Viewpoints& before = known(roadmap.passages());
  if (const auto it = before.find(cluster.id);
      it != before.end() && it->second.revision == entry.revision && it->second.cells == entry.cells) {
    entry.viewpoint = it->second.viewpoint;
    return entry;
  }
  if (open_cells(map, cluster) < min_open_cells_) return entry;
  const bool narrow = roadmap.passages() == Passages::narrow;
  entry.viewpoint =
      find_viewpoint(map, cluster, vehicle_, roadmap.clearance_m(), narrow ? &roadmap.roadmap() : nullptr);
  if (!entry.viewpoint && !explained_.contains(cluster.id)) explain_unseen(cluster, roadmap.clearance_m());
  return entry;
}

/// If a vehicle with an all-round view could see the frontier, the sensors' field of view is the reason.
void FrontierOffers::explain_unseen(const FrontierCluster& cluster, double clearance_m) {
  auto sphere = std::make_shared<LidarModel>();
  sphere->elevation_rad = {std::numbers::pi_v<float> / 2, -std::numbers::pi_v<float> / 2};
  VehicleDescription all_seeing = vehicle_;
  all_seeing.lidar = sphere;
  const auto from = find_viewpoint(world_->map(), cluster, all_seeing, clearance_m);
  if (!from) return;
  explained_.insert(cluster.id);
  const double rise_m = cluster.centroid.z() - from->position.z();
  const std::string where = std::abs(rise_m) < world_->map().resolution_m() ? "beside"
                            : rise_m > 0                                    ? "above"
                                                                            : "below";
  unseen_.push_back(
      {cluster.id, cluster.centroid,
       "no sensor of the vehicle sees what lies " + where + " it there, and it flies into nothing unseen"});
}

}  // namespace karst::core
