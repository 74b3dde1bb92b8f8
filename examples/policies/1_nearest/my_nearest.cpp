// Flies to the frontier with the shortest way to it.
#include <karst/policy.h>

#include <algorithm>
#include <cstdio>

namespace {

class MyNearest : public karst::Policy {
 public:
  void parameters(karst::Parameters& p) override {
    p.add("min_cells", min_cells_, 1, 10000, "smaller frontiers are ignored: they are seldom openings");
  }

  karst::Decision decide(const karst::Request& request) override {
    std::vector<karst::Goal> goals;
    for (const karst::Frontier& f : request.frontiers) {
      if (!f.reachable() || f.cells < static_cast<std::uint32_t>(min_cells_)) continue;
      char why[80];
      std::snprintf(why, sizeof why, "%.1f m away", f.path_length_m);
      goals.push_back(karst::goal_at(f, -f.path_length_m, why));
    }
    if (goals.empty()) return karst::Decision::explored("no frontier can be reached");
    std::sort(goals.begin(), goals.end(), [](const karst::Goal& a, const karst::Goal& b) {
      return a.score != b.score ? a.score > b.score : a.frontier_id < b.frontier_id;
    });
    goals.resize(std::min<std::size_t>(goals.size(), 10));
    return karst::Decision::fly(goals);
  }

 private:
  int min_cells_ = 10;
};

}  // namespace

KARST_POLICY(MyNearest, "my_nearest", "0.1.0", "Flies to the frontier with the shortest way to it.")
