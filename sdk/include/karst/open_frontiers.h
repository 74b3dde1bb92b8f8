// The frontiers worth considering: the filter that most policies apply before they choose.
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
  double patience_s = 3.0;      // without a goal for that long, the cave counts as explored

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
    double revisit_penalty_m;  // cost of earlier visits that left the frontier, in metres of flight
  };

  /// The frontiers that can be flown to now, by ascending id; the pointers live as long as the request.
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

  /// A goal was found: restarts the time that `patience_s` limits.
  void found_some() { idle_since_ns_ = -1; }

  /// The answer when there is nothing to fly to: hold, or explored.
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

/// Whether `f` is the goal under way: the core moves a viewpoint a little when the map changes.
inline bool under_way(const Request& request, const Frontier& f) {
  constexpr double same_place_m = 1.6;
  return request.last_fate == KARST_FATE_UNDER_WAY && distance(f.viewpoint, request.last_goal) < same_place_m;
}

/// 0 if the frontier's viewpoint lies straight ahead in the direction of flight, 1 if it lies behind.
inline double turn_fraction(const Request& request, const Frontier& f) {
  const Vec3 there = f.viewpoint - request.position();
  return 0.5 * (1.0 - dot(there, request.direction_of_flight) / std::max(norm(there), 1e-9));
}

}  // namespace karst
