#include "core_stack/team/relay_homing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core_stack/homing/path_home/home.h"
#include "core_stack/homing/path_home/map_rays.h"
#include "core_stack/planning/search/grid_planner.h"

namespace karst::core {
namespace {

constexpr double kSiteRadius_m = 3.0;     // of a landing site from the pose it is judged for
constexpr std::size_t kJudgedBehind = 3;  // poses later the ground there has been observed
constexpr double kRecheckMargin_m = 1.0;
constexpr double kRockMargin_m = 0.1;   // beyond the vehicle's radius: nearer rock blocks a ray
constexpr double kBesideRoute_m = 4.0;  // landing sites this near to the homing route are on it
/// Reserve for checking radio contact at the site, and for moving nearer without contact.
constexpr double kConfirm_s = 6.0;
/// Reserve for another site if the node has yet to land, and the margin by which its battery must end first.
constexpr double kClaimed_s = 10.0;
/// Each site without contact to a node raises the link margin required of further sites by this much, since
/// sites beside it would fail as well.
constexpr double kDoubt_db = 3.0;
constexpr double kMaxFall_m = 5.0;  // of a node that is dropped
/// A node is dropped if the link margin one second ahead is below this: its link cannot be tested before it
/// lies there.
constexpr double kNodeSpare_db = 1.0;
constexpr std::size_t kFirstBatch = 8;  // of sites to which a path is planned
constexpr TimeNs kSurelyBefore = 30 * kSecond;

void append(TreeFacts& to, const TreeFacts& more) {
  to.nodes.insert(to.nodes.end(), more.nodes.begin(), more.nodes.end());
  to.rays.insert(to.rays.end(), more.rays.begin(), more.rays.end());
  to.lives.insert(to.lives.end(), more.lives.begin(), more.lives.end());
}

/// Where a dropped node lands: it keeps the vehicle's velocity while it falls. It may come to rest on a slope
/// or among stones.
std::optional<Vec3> ground_of_node(const VoxelMap& map, const Release& release) {
  constexpr double kGravity_mps2 = 9.81;
  Vec3 at = release.position;
  Ground below;
  for (int i = 0; i < 3; ++i) {  // the ground there may be lower than below the vehicle
    below = ground_below(map, at, 0, {.margin_m = 0, .max_drop_m = kMaxFall_m});
    if (below.verdict == GroundVerdict::no_floor || below.verdict == GroundVerdict::unknown)
      return std::nullopt;
    const double up_mps = release.velocity_mps.z(), height_m = at.z() - below.ground.z();
    const double fall_s =
        (up_mps + std::sqrt(up_mps * up_mps + 2 * kGravity_mps2 * height_m)) / kGravity_mps2;
    at.head<2>() = (release.position + fall_s * release.velocity_mps).head<2>();
  }
  return below.ground;
}

}  // namespace

RelayHoming::RelayHoming(RobotId self, const RelayHomingSetup& setup)
    : self_(self),
      strategy_(setup.team.strategy),
      options_(setup.homing),
      planning_(setup.planning),
      limits_(setup.motion),
      radius_m_(setup.vehicle_radius_m),
      separation_m_(setup.homing.landing.separation_m),
      tree_(setup.homing.tree, cruise_speed_mps(setup.motion)) {
  const FreeRay unseen = [](const Vec3&, const Vec3&) { return false; };
  tree_.insert_communication({kBase, 1}, to_centimetres(setup.base), 0, unseen);
  relays_ = {{kBase, setup.base, setup.base}};
}

TreeFacts RelayHoming::update(const VoxelMap& map, const Roadmap& roadmap, const Vec3& here,
                              const TeamNews& news, std::span<const CellKey> closed) {
  relays_ = news.relays;
  taken_ = news.taken;
  goals_ = news.goals;
  std::erase_if(relays_, [&](const Relay& r) {
    return r.stands_by && (strategy_ != LandingStrategy::relay_chain ||
                           *r.stands_by + kSurelyBefore > news.ends || has_failed(r));
  });
  const FreeRay free = free_rays(roadmap, search_clearance_m(planning_, map.resolution_m()));
  const TimeNs stamp = to_milliseconds(news.stamp);
  TreeFacts out;
  tree_.apply(news.facts);
  for (const TreeNode& n : news.facts.nodes) append(out, tree_.look_from(n.id, stamp, free));

  const TreeFacts own = tree_.insert_pose({self_, nodes_made_ + 1}, to_centimetres(here), stamp, free);
  if (!own.nodes.empty()) {
    ++nodes_made_;
    append(out, own);
  }
  // This includes places with other robots' nodes, as their ground is unknown to this robot.
  const bool judged = std::any_of(passed_.begin(), passed_.end(), [&](const Vec3& p) {
    return (p - here).norm() < options_.tree.min_edge_m;
  });
  if (!judged) {
    passed_.push_back(here);
    to_judge_.push_back(here);
  }
  if (!closed.empty()) {
    Vec3 low = map.center_of(closed.front()), high = low;
    for (const CellKey& k : closed) {
      low = low.cwiseMin(map.center_of(k));
      high = high.cwiseMax(map.center_of(k));
    }
    append(out, tree_.recheck(low, high, kRecheckMargin_m, stamp, free,
                              rock_rays(map, radius_m_ + kRockMargin_m)));
  }
  while (to_judge_.size() > kJudgedBehind) {
    judge(map, roadmap, to_judge_.front());
    to_judge_.erase(to_judge_.begin());
  }
  find_links(map);
  return out;
}

double RelayHoming::margin_db(const VoxelMap& map, const Vec3& ground, const Relay& to) const {
  return expected_margin_db(map, ground + Vec3(0, 0, radius_m_), to.antenna, options_.landing.link) -
         doubt_db_[to.robot];
}

double RelayHoming::down_s(const LandingSite& site) const {
  return (site.hover - site.ground).z() / options_.landing.landing_speed_mps;
}

void RelayHoming::look_around(const VoxelMap& map, const Roadmap& roadmap, const Vec3& here) {
  to_judge_.push_back(here);
  for (const Vec3& pose : std::exchange(to_judge_, {})) judge(map, roadmap, pose);
  find_links(map);
}

/// The site near a pose where the vehicle can land soonest.
void RelayHoming::judge(const VoxelMap& map, const Roadmap& roadmap, const Vec3& pose) {
  std::vector<LandingSite> candidates;
  for (const Vec3& p : roadmap.places_near(pose, kSiteRadius_m)) {
    if (!is_clear(map, p, planning_.clearance_m))
      continue;  // with the search clearance alone there may be no path
    const Ground ground = ground_below(map, p, radius_m_, options_.landing.ground);
    if (ground.verdict == GroundVerdict::good) candidates.push_back({p, ground.ground, std::nullopt});
  }
  const auto cost_s = [&](const LandingSite& p) {
    return (p.hover - pose).norm() / cruise_speed_mps(limits_) + down_s(p);
  };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const LandingSite& a, const LandingSite& b) { return cost_s(a) < cost_s(b); });
  for (const LandingSite& p : candidates) {
    const Vec3 standing = p.ground + Vec3(0, 0, radius_m_);
    if (!keeps_passage_open(map, standing, radius_m_ + kAsMapped_m,
                            search_clearance_m(planning_, map.resolution_m()),
                            options_.landing.passage_radius_m))
      continue;
    const bool there = std::any_of(sites_.begin(), sites_.end(), [&](const LandingSite& o) {
      return (o.ground - p.ground).norm() < options_.tree.min_edge_m / 2;
    });
    if (!there) sites_.push_back(p);
    return;
  }
}

/// Assigns to each site the node with the best predicted link; a node that has yet to land only if there is
/// no other. A link in use is kept while half of its required margin is left. Otherwise a relay that landed a
/// few centimetres off could invalidate the site that a robot far away relies on.
void RelayHoming::find_links(const VoxelMap& map) {
  for (LandingSite& p : sites_) {
    double best_db = -std::numeric_limits<double>::infinity();
    const std::optional<RobotId> before = std::exchange(p.node, std::nullopt);
    for (const Relay& r : relays_) {
      if (r.stands_by && p.node && !p.claimed) break;  // nodes yet to land come last
      if ((r.antenna - p.ground).norm() > options_.landing.link.range_m + 1)
        continue;  // avoids casting a long ray
      const double db = margin_db(map, p.ground, r);
      const double min_db = before == r.robot ? -options_.landing.link.spare_db / 2 : 0;
      if (db >= min_db && db >= best_db) {
        best_db = db;
        p.node = r.robot;
        p.claimed = r.stands_by.has_value();
      }
    }
  }
}

void RelayHoming::no_contact_at(const LandingSpot& spot) {
  give_up(spot.hover);
  const auto relay =
      std::find_if(relays_.begin(), relays_.end(), [&](const Relay& r) { return r.robot == spot.node; });
  if (relay != relays_.end() && relay->stands_by)
    failed_antennas_[spot.node] = relay->antenna;
  else if (relay != relays_.end() || !spot.claimed)
    doubt_db_[spot.node] += kDoubt_db;
  std::erase_if(relays_, [this](const Relay& r) { return r.stands_by && has_failed(r); });
  for (LandingSite& p : sites_)
    if (p.node == spot.node) p.node.reset();  // links in use lose their hysteresis
}

bool RelayHoming::has_failed(const Relay& relay) const {
  const auto& antenna = failed_antennas_[relay.robot];
  return antenna && (*antenna - relay.antenna).norm() < 1e-3;
}

bool RelayHoming::free_to_take(const LandingSite& site) const {
  const auto near = [&](const std::vector<Vec3>& all, const Vec3& p, double within_m) {
    return std::any_of(all.begin(), all.end(), [&](const Vec3& o) { return (o - p).norm() < within_m; });
  };
  return !near(taken_, site.ground, separation_m_) && !near(given_up_, site.hover, 1e-3);
}

/// Visits sites by straight-line distance, a lower bound of the path length, so that few need a path query.
std::optional<LandingSpot> RelayHoming::nearest_place(const VoxelMap& map, const Roadmap& roadmap,
                                                      const Vec3& from, double sooner_than_s) const {
  struct Candidate {
    const LandingSite* site;
    double min_s;
  };
  const auto time_s = [this](const LandingSite& p, double length_m) {
    return flight_time_s(length_m, limits_) + kConfirm_s + (p.claimed ? kClaimed_s : 0.0) + down_s(p);
  };
  std::vector<Candidate> open;
  for (const LandingSite& p : sites_)
    if (p.node && free_to_take(p)) open.push_back({&p, time_s(p, (p.hover - from).norm())});
  std::stable_sort(open.begin(), open.end(),
                   [](const Candidate& a, const Candidate& b) { return a.min_s < b.min_s; });
  std::optional<LandingSpot> best;
  double best_s = sooner_than_s;
  for (std::size_t first = 0, batch = kFirstBatch; first < open.size(); first += batch, batch = open.size()) {
    std::vector<Vec3> hovers;
    for (std::size_t i = first; i < std::min(first + batch, open.size()) && open[i].min_s < best_s; ++i)
      hovers.push_back(open[i].site->hover);
    if (hovers.empty()) break;
    const std::vector<double> lengths =
        roadmap.distances(map, from, hovers, 0.0, best_s * cruise_speed_mps(limits_));
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      const LandingSite& p = *open[first + i].site;
      const double s = time_s(p, lengths[i]);
      if (s < best_s) {
        best_s = s;
        best = {p.hover, p.ground, *p.node, p.claimed, lengths[i], s};
      }
    }
  }
  return best;
}

/// The first site beside the homing route that is in range of the route's node.
std::optional<LandingSpot> RelayHoming::up_the_tree(const VoxelMap& map, const Roadmap& roadmap,
                                                    const Vec3& from) const {
  const FreeRay free = free_rays(roadmap, search_clearance_m(planning_, map.resolution_m()));
  const auto route = tree_.route(from, free);
  if (!route || route->nodes.empty()) return std::nullopt;
  const RobotId node = route->nodes.back().robot;
  const auto relay =
      std::find_if(relays_.begin(), relays_.end(), [&](const Relay& r) { return r.robot == node; });
  if (relay == relays_.end()) return std::nullopt;
  double length_m = 0;
  for (std::size_t i = 0; i < route->points.size(); ++i) {
    const Vec3& p = route->points[i];
    if (i > 0) length_m += (p - route->points[i - 1]).norm();
    const LandingSite* best = nullptr;
    for (const LandingSite& site : sites_)
      if ((site.hover - p).norm() < kBesideRoute_m && free_to_take(site) &&
          margin_db(map, site.ground, *relay) >= 0 &&
          (!best || (site.hover - p).norm() < (best->hover - p).norm()))
        best = &site;
    if (!best) continue;
    const double all_m = length_m + (best->hover - p).norm();
    return LandingSpot{best->hover, best->ground, node,
                       false,       all_m,        flight_time_s(all_m, limits_) + kConfirm_s + down_s(*best)};
  }
  return std::nullopt;
}

std::optional<LandingSpot> RelayHoming::spot_from(const VoxelMap& map, const Roadmap& roadmap,
                                                  const Vec3& from, double sooner_than_s) const {
  if (strategy_ == LandingStrategy::relay_chain) return nearest_place(map, roadmap, from, sooner_than_s);
  const auto spot = strategy_ == LandingStrategy::relay_tree ? up_the_tree(map, roadmap, from) : std::nullopt;
  return spot && spot->time_s < sooner_than_s ? spot : std::nullopt;
}

std::optional<Vec3> RelayHoming::relay_drop_site(const VoxelMap& map, const Release& here,
                                                 const Release& ahead) const {
  const auto in_range = [&](const Vec3& ground, double min_db) {
    return std::any_of(relays_.begin(), relays_.end(),
                       [&](const Relay& r) { return !r.stands_by && margin_db(map, ground, r) >= min_db; });
  };
  const std::optional<Vec3> ground = ground_of_node(map, here);
  if (!ground || !in_range(*ground, 0)) return std::nullopt;
  const Vec3 next = ground_of_node(map, ahead).value_or(*ground + ahead.position - here.position);
  return in_range(next, kNodeSpare_db) ? std::nullopt : ground;
}

TreeFacts RelayHoming::land(const VoxelMap& map, const Roadmap& roadmap, const Vec3& hover, TimeNs stamp) {
  const FreeRay free = free_rays(roadmap, search_clearance_m(planning_, map.resolution_m()));
  return tree_.insert_communication({self_, ++nodes_made_}, to_centimetres(hover), to_milliseconds(stamp),
                                    free);
}

}  // namespace karst::core
