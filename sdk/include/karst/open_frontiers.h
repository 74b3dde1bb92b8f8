// The frontiers worth thinking about: what most policies sort out before they begin to choose.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include <karst/goal_history.h>
#include <karst/policy.h>

namespace karst {

class OpenFrontiers {
 public:
  int min_cells = 10;           // smaller clusters are seldom openings
  double min_distance_m = 0.6;  // a viewpoint nearer than that shows nothing new
  double patience_s = 3.0;      // nothing to fly to for that long: explored

  void parameters(Parameters& p) {
    p.add("min_cells", min_cells, 1, 10000, "smaller frontier clusters are ignored");
    p.add("min_distance", min_distance_m, "m", 0, 10, "viewpoints nearer than this are ignored");
    p.add("patience", patience_s, "s", 0, 120, "without any goal for this long, the cave counts as explored");
  }

  void on_event(const Event& event) { entries_.on_event(event); }
  void memory(Memory& m) {
    m.add(entries_);
    m.add(idle_since_ns_);
  }

  struct Candidate {
    const Frontier* frontier;
    double revisit_penalty_m;  // what earlier visits in vain count as, in metres of flight
  };

  /// Those that can be flown to now, by id; they live as long as the request.
  std::vector<Candidate> of(const Request& request) {
    std::vector<Candidate> open;
    some_closed_ = false;
    for (const Frontier& f : request.frontiers) {
      if (!f.reachable() || f.cells < static_cast<std::uint32_t>(min_cells)) continue;
      if (distance(f.viewpoint, request.position()) < min_distance_m) continue;
      const GoalHistory::Verdict verdict = entries_.judge(f, request.stamp_ns);
      some_closed_ |= verdict.closed_now;
      if (verdict.open) open.push_back({&f, verdict.revisit_penalty_m});
    }
    return open;
  }

  /// Something is being flown to: patience begins anew.
  void found_some() { idle_since_ns_ = -1; }

  /// What to answer when there is nothing to fly to.
  Decision none_left(const Request& request) {
    if (idle_since_ns_ < 0) idle_since_ns_ = request.stamp_ns;
    if (some_closed_)
      return Decision::hold("every frontier left failed a short while ago: waiting to try again");
    if (static_cast<double>(request.stamp_ns - idle_since_ns_) * 1e-9 < patience_s)
      return Decision::hold("no frontier can be reached: waiting for the map to settle");
    return Decision::explored("no frontier can be reached");
  }

 private:
  GoalHistory entries_;
  bool some_closed_ = false;
  std::int64_t idle_since_ns_ = -1;
};

/// The core moves a viewpoint a little when the map changes: the goal under way is still the same.
inline bool under_way(const Request& request, const Frontier& f) {
  constexpr double same_place_m = 1.6;
  return request.last_fate == KARST_FATE_UNDER_WAY && distance(f.viewpoint, request.last_goal) < same_place_m;
}

/// 0 for flying straight on to the frontier's viewpoint, 1 for turning back.
inline double turn_fraction(const Request& request, const Frontier& f) {
  const Vec3 there = f.viewpoint - request.position();
  return 0.5 * (1.0 - dot(there, request.direction_of_flight) / std::max(norm(there), 1e-9));
}

}  // namespace karst
