// Remembers visited and failed goals: a frontier that remains after a visit cannot be seen from there, and a
// rejected goal is likely to be rejected again.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include <karst/memory.h>
#include <karst/types.h>

namespace karst {

class GoalHistory {
 public:
  struct Verdict {
    bool open = true;              // worth proposing now
    bool closed_now = false;       // not open now, but again later
    double revisit_penalty_m = 0;  // to be subtracted from its score
  };

  void on_event(const Event& event) {
    switch (event.kind) {
      case KARST_EVENT_GOAL_REACHED:
        ++entry_of(event.goal).visits;
        break;
      case KARST_EVENT_GOAL_REJECTED:
      case KARST_EVENT_GOAL_UNREACHABLE:
      case KARST_EVENT_GOAL_ABANDONED: {
        Entry& p = entry_of(event.goal);
        ++p.failures;
        p.closed_until_ns = event.stamp_ns + (first_pause_ns << std::min(p.failures - 1, 5));
        break;
      }
      default:
        break;
    }
  }

  void memory(Memory& m) { m.add(entries_); }

  Verdict judge(const Frontier& f, std::int64_t now_ns) const {
    Verdict v;
    for (const Entry& p : entries_) {
      if (distance(p.position, f.viewpoint) > same_place_m) continue;
      v.revisit_penalty_m += visit_cost_m * p.visits;
      if (p.visits >= max_visits || p.failures >= max_failures) {
        v.open = false;
      } else if (now_ns < p.closed_until_ns) {
        v.open = false;
        v.closed_now = true;
      }
    }
    return v;
  }

 private:
  static constexpr double same_place_m = 0.8;
  static constexpr double visit_cost_m = 10.0;
  static constexpr int max_visits = 3, max_failures = 4;
  static constexpr std::int64_t first_pause_ns = 4'000'000'000;

  struct Entry {
    Vec3 position;
    int visits = 0, failures = 0;
    std::int64_t closed_until_ns = 0;
  };

  Entry& entry_of(const Goal& goal) {
    for (Entry& p : entries_)
      if (distance(p.position, goal.position) <= same_place_m) return p;
    entries_.push_back({goal.position});
    return entries_.back();
  }

  std::vector<Entry> entries_;
};

}  // namespace karst
