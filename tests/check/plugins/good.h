// A policy that holds everything `karst policy check` asks for. Each bad one derives from it and spoils one
// thing.
#pragma once
#include <karst/policy.h>

#include <algorithm>

namespace karst::test {

class Good : public karst::Policy, public karst::Restorable {
 public:
  void parameters(karst::Parameters& p) override {
    p.add("reach", reach_m_, "m", 1, 100, "frontiers with a longer way to them come last");
    p.add("label", label_, "", "put before every reason");
  }

  karst::Decision decide(const karst::Request& request) override {
    ++decisions_;
    std::vector<karst::Goal> goals;
    std::vector<karst::Vec3> places;
    for (const karst::Frontier& f : request.frontiers) {
      if (!f.reachable() || request.map.cell(f.viewpoint) != karst::Cell::free || places.size() == 20)
        continue;
      const double late_m = f.path_length_m > reach_m_ ? 1000 : 0;
      goals.push_back(
          karst::goal_at(f, -f.path_length_m - late_m + 1e-3 * request.random(),
                         label_.substr(0, 20) + "nearest; decision " + std::to_string(decisions_)));
      places.push_back(f.viewpoint);
    }
    if (goals.empty()) return karst::Decision::hold("nothing can be reached");
    request.draw_points(places, 0x00ff00);
    if (!request.path_lengths(request.position(), places, 0.5).empty()) request.log("asked for paths");
    std::sort(goals.begin(), goals.end(),
              [](const karst::Goal& a, const karst::Goal& b) { return a.score > b.score; });
    return karst::Decision::fly(std::move(goals));
  }

  void memory(karst::Memory& m) override { m.add(decisions_); }

 protected:
  double reach_m_ = 20;
  std::string label_;
  int decisions_ = 0;
};

}  // namespace karst::test
