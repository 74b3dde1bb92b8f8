// Places where a goal came to nothing: a frontier still there after a visit cannot be seen from there, and
// a goal refused is likely to be refused again.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include <karst/memory.h>
#include <karst/types.h>

namespace karst {

class PlaceMemory {
 public:
  struct Verdict {
    bool open = true;         // worth proposing now
    bool closed_now = false;  // not now, but later
    double reluctance_m = 0;  // to be taken from its score
  };

  void on_event(const Event& event) {
    switch (event.kind) {
      case KARST_EVENT_GOAL_REACHED:
        ++place_of(event.goal).visits;
        break;
      case KARST_EVENT_GOAL_REJECTED:
      case KARST_EVENT_GOAL_UNREACHABLE:
      case KARST_EVENT_GOAL_ABANDONED: {
        Place& p = place_of(event.goal);
        ++p.failures;
        p.closed_until_ns = event.stamp_ns + (first_pause_ns << std::min(p.failures - 1, 5));
        break;
      }
      default:
        break;
    }
  }

  void memory(Memory& m) { m.add(places_); }

  Verdict judge(const Frontier& f, std::int64_t now_ns) const {
    Verdict v;
    for (const Place& p : places_) {
      if (distance(p.position, f.viewpoint) > same_place_m) continue;
      v.reluctance_m += visit_cost_m * p.visits;
      if (p.visits >= most_visits || p.failures >= most_failures)
        v.open = false;
      else if (now_ns < p.closed_until_ns)
        v.open = false, v.closed_now = true;
    }
    return v;
  }

 private:
  static constexpr double same_place_m = 0.8;
  static constexpr double visit_cost_m = 10.0;
  static constexpr int most_visits = 3, most_failures = 4;
  static constexpr std::int64_t first_pause_ns = 4'000'000'000;

  struct Place {
    Vec3 position;
    int visits = 0, failures = 0;
    std::int64_t closed_until_ns = 0;
  };

  Place& place_of(const Goal& goal) {
    for (Place& p : places_)
      if (distance(p.position, goal.position) <= same_place_m) return p;
    places_.push_back({goal.position});
    return places_.back();
  }

  std::vector<Place> places_;
};

}  // namespace karst
