// From a merit for each frontier to a ranked decision: what most greedy policies share.
//
// All scores are in metres of flight, so that weights can be read: a frontier that is worth 5 m more is
// chosen although its path is 5 m longer (at path_weight 1).
#pragma once
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <karst/place_memory.h>
#include <karst/policy.h>

namespace karst {

/// What a policy sees in a frontier, before the flight to it is charged.
struct Merit {
  double worth_m = 0;
  std::string why;
};

class Ranking {
 public:
  int min_cells = 10;           // smaller clusters are seldom openings
  double min_distance_m = 0.6;  // a viewpoint nearer than that shows nothing new
  double path_weight = 1.0;     // metres of worth for a metre of path
  double horizon_m = 30.0;      // path beyond it is charged once more: the vehicle works where it is
  double turn_cost_m = 4.0;     // charged for flying straight back, in part for turning
  double keep_bonus_m = 4.0;    // for the goal under way: nearly equal goals must not take turns
  int goals = 8;
  double patience_s = 3.0;  // nothing to fly to for that long: explored

  void parameters(Parameters& p) {
    p.add("min_cells", min_cells, 1, 10000, "smaller frontier clusters are ignored");
    p.add("min_distance", min_distance_m, "m", 0, 10, "viewpoints nearer than this are ignored");
    p.add("path_weight", path_weight, "", 0, 10, "what a metre of path costs");
    p.add("horizon", horizon_m, "m", 1, 1000,
          "a path longer than this costs a metre more for each metre beyond");
    p.add("turn_cost", turn_cost_m, "m", 0, 100, "what flying straight back costs; less for smaller turns");
    p.add("keep_bonus", keep_bonus_m, "m", 0, 100, "bonus of the goal under way, against dithering");
    p.add("goals", goals, 1, 32, "how many goals to propose, best first");
    p.add("patience", patience_s, "s", 0, 120, "without any goal for this long, the cave counts as explored");
  }

  void on_event(const Event& event) { places_.on_event(event); }
  void memory(Memory& m) { m.add(places_), m.add(idle_since_ns_); }

  /// `merit_of(frontier)` for each frontier that can be flown to; the best become goals.
  template <class MeritOf>
  Decision decide(const Request& request, MeritOf&& merit_of) {
    std::vector<Goal> ranked;
    bool some_closed = false;
    for (const Frontier& f : request.frontiers) {
      if (!f.reachable() || f.cells < static_cast<std::uint32_t>(min_cells)) continue;
      if (distance(f.viewpoint, request.position()) < min_distance_m) continue;
      const PlaceMemory::Verdict verdict = places_.judge(f, request.stamp_ns);
      some_closed |= verdict.closed_now;
      if (!verdict.open) continue;
      Merit merit = merit_of(f);
      ranked.push_back(goal_at(f, score(request, f, merit) - verdict.reluctance_m, std::move(merit.why)));
    }
    if (ranked.empty()) return nothing_left(request, some_closed);
    idle_since_ns_ = -1;
    std::sort(ranked.begin(), ranked.end(), [](const Goal& a, const Goal& b) {
      return a.score != b.score ? a.score > b.score : a.frontier_id < b.frontier_id;
    });
    if (ranked.size() > static_cast<std::size_t>(goals)) ranked.resize(static_cast<std::size_t>(goals));
    return Decision::fly(std::move(ranked));
  }

 private:
  double score(const Request& request, const Frontier& f, const Merit& merit) const {
    const Vec3 there = f.viewpoint - request.position();
    const double cosine = dot(there, request.direction_of_flight) / std::max(norm(there), 1e-9);
    double s = merit.worth_m - path_weight * f.path_length_m - turn_cost_m * 0.5 * (1.0 - cosine);
    s -= std::max(0.0, f.path_length_m - horizon_m);
    return s + (under_way(request, f) ? keep_bonus_m : 0.0);
  }

  /// The core moves a viewpoint a little when the map changes: the goal is still the same.
  static bool under_way(const Request& request, const Frontier& f) {
    constexpr double same_place_m = 1.6;
    return request.last_fate == KARST_FATE_UNDER_WAY &&
           distance(f.viewpoint, request.last_goal) < same_place_m;
  }

  Decision nothing_left(const Request& request, bool some_closed) {
    if (idle_since_ns_ < 0) idle_since_ns_ = request.stamp_ns;
    if (some_closed)
      return Decision::hold("every frontier left failed a short while ago: waiting to try again");
    if (static_cast<double>(request.stamp_ns - idle_since_ns_) * 1e-9 < patience_s)
      return Decision::hold("no frontier can be reached: waiting for the map to settle");
    return Decision::explored("no frontier can be reached");
  }

  PlaceMemory places_;
  std::int64_t idle_since_ns_ = -1;
};

}  // namespace karst
