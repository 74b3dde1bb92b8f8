// From a merit for each frontier to a ranked decision: the part that most greedy policies share.
//
// All scores are in metres of flight, so that weights are easy to read: a frontier that is worth 5 m more
// balances a path that is 5 m longer (at path_weight 1).
#pragma once
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <karst/open_frontiers.h>

namespace karst {

/// The value of a frontier to a policy, in metres of flight, before the cost of the flight to it.
struct Merit {
  double worth_m = 0;
  std::string why;
};

/// Sorts by score, best first, and keeps the first `most`.
inline void keep_best(std::vector<Goal>& goals, std::size_t most) {
  std::sort(goals.begin(), goals.end(), [](const Goal& a, const Goal& b) {
    return a.score != b.score ? a.score > b.score : a.frontier_id < b.frontier_id;
  });
  if (goals.size() > most) goals.resize(most);
}

class Ranking {
 public:
  double path_weight = 1.0;   // metres of worth for a metre of path
  double horizon_m = 30.0;    // each metre of path beyond it costs one metre more: prefers near frontiers
  double turn_cost_m = 4.0;   // cost of flying straight back; a fraction of it for smaller turns
  double keep_bonus_m = 4.0;  // for the goal under way, so that the choice does not dither
  int goals = 8;

  void parameters(Parameters& p) {
    open_.parameters(p);
    p.add("path_weight", path_weight, "", 0, 10, "what a metre of path costs");
    p.add("horizon", horizon_m, "m", 1, 1000,
          "a path longer than this costs a metre more for each metre beyond");
    p.add("turn_cost", turn_cost_m, "m", 0, 100, "what flying straight back costs; less for smaller turns");
    p.add("keep_bonus", keep_bonus_m, "m", 0, 100, "bonus of the goal under way, against dithering");
    p.add("goals", goals, 1, 32, "how many goals to propose, best first");
  }

  void on_event(const Event& event) { open_.on_event(event); }
  void memory(Memory& m) { m.add(open_); }

  /// Calls `merit_of(frontier)`, a Merit, for each frontier that can be flown to; the best become goals.
  template <class MeritOf>
  Decision decide(const Request& request, MeritOf&& merit_of) {
    std::vector<Goal> ranked;
    for (const auto& [f, revisit_penalty_m] : open_.of(request)) {
      Merit merit = merit_of(*f);
      ranked.push_back(goal_at(*f, score(request, *f, merit) - revisit_penalty_m, std::move(merit.why)));
    }
    if (ranked.empty()) return open_.none_left(request);
    open_.found_some();
    keep_best(ranked, static_cast<std::size_t>(goals));
    return Decision::fly(std::move(ranked));
  }

 private:
  double score(const Request& request, const Frontier& f, const Merit& merit) const {
    double s = merit.worth_m - path_weight * f.path_length_m - turn_cost_m * turn_fraction(request, f);
    s -= std::max(0.0, f.path_length_m - horizon_m);
    return s + (under_way(request, f) ? keep_bonus_m : 0.0);
  }

  OpenFrontiers open_;
};

}  // namespace karst
