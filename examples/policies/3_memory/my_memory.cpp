// Explores branch by branch: on to what was found last, back to older openings later. It remembers, from one
// decision to the next, when each frontier was first seen, what it flies to, and where it went in vain; and
// it still does after a crash.
#include <karst/memory.h>
#include <karst/policy.h>

#include <algorithm>
#include <cstdio>
#include <map>

namespace {

class MyMemory : public karst::Policy, public karst::Restorable {
 public:
  void parameters(karst::Parameters& p) override {
    p.add("min_cells", min_cells_, 1, 10000, "smaller frontiers are ignored: they are seldom openings");
    p.add("seconds_per_metre", seconds_per_metre_, "", 0, 100,
          "how much older a frontier seems for a metre of way");
    p.add("rest", rest_s_, "s", 0, 3600, "a place where a goal came to nothing is left alone for this long");
  }

  karst::Decision decide(const karst::Request& request) override {
    for (const karst::Frontier& f : request.frontiers) first_seen_s_.emplace(f.id, seconds(request.stamp_ns));
    std::vector<karst::Goal> goals;
    bool some_rest = false;
    for (const karst::Frontier& f : request.frontiers) {
      if (!f.reachable() || f.cells < static_cast<std::uint32_t>(min_cells_)) continue;
      if (rests(f.viewpoint, request.stamp_ns)) {
        some_rest = true;
        continue;
      }
      const double age_s = seconds(request.stamp_ns) - first_seen_s_.at(f.id);
      char why[120];
      std::snprintf(why, sizeof why, "seen for %.0f s, %.1f m away%s", age_s, f.path_length_m,
                    f.id == under_way_ ? ", under way" : "");
      const double bonus = f.id == under_way_ ? kept_bonus_s : 0.0;
      goals.push_back(karst::goal_at(f, bonus - age_s - seconds_per_metre_ * f.path_length_m, why));
    }
    if (goals.empty())
      return some_rest ? karst::Decision::hold("what is left was tried a short while ago")
                       : karst::Decision::explored("no frontier can be reached");
    std::sort(goals.begin(), goals.end(), [](const karst::Goal& a, const karst::Goal& b) {
      return a.score != b.score ? a.score > b.score : a.frontier_id < b.frontier_id;
    });
    goals.resize(std::min<std::size_t>(goals.size(), 10));
    under_way_ = goals.front().frontier_id;
    return karst::Decision::fly(goals);
  }

  void on_event(const karst::Event& event) override {
    switch (event.kind) {
      case KARST_EVENT_GOAL_REACHED:
        break;
      case KARST_EVENT_GOAL_REJECTED:
      case KARST_EVENT_GOAL_UNREACHABLE:
      case KARST_EVENT_GOAL_ABANDONED:
        failed_.push_back({event.goal.position, event.stamp_ns});
        break;
      default:
        return;  // also for kinds that later versions add
    }
    if (event.goal.frontier_id == under_way_) under_way_ = 0;
  }

  void memory(karst::Memory& m) override {
    m.add(first_seen_s_);
    m.add(failed_);
    m.add(under_way_);
  }

 private:
  struct FailedGoal {
    karst::Vec3 position;
    std::int64_t since_ns;
  };
  static double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

  bool rests(const karst::Vec3& place, std::int64_t now_ns) const {
    return std::any_of(failed_.begin(), failed_.end(), [&](const FailedGoal& p) {
      return karst::distance(p.position, place) < same_place_m && seconds(now_ns - p.since_ns) < rest_s_;
    });
  }

  static constexpr double same_place_m = 0.8;
  static constexpr double kept_bonus_s = 8.0;  // nearly equal goals must not take turns

  int min_cells_ = 10;
  double seconds_per_metre_ = 1.0;
  double rest_s_ = 20.0;

  std::map<std::uint32_t, double> first_seen_s_;  // by id of the frontier, seconds of mission time
  std::vector<FailedGoal> failed_;
  std::uint32_t under_way_ = 0;  // the frontier flown to; 0: none
};

}  // namespace

KARST_POLICY(MyMemory, "my_memory", "0.1.0", "Explores branch by branch: what was found last comes first.")
