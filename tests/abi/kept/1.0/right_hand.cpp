// Keeps to the right: of all frontiers within reach, the one furthest to the right of the flight that is not
// too far. Built with nothing but the installed SDK.
#include <karst/policy.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

class RightHand : public karst::Policy {
 public:
  void parameters(karst::Parameters& p) override {
    p.add("reach", reach_m_, "m", 1, 200,
          "frontiers with a longer way to them count only if there is no other");
    p.add("tolerance", tolerance_m_, "m", 0.1, 5, "how near to a viewpoint is near enough");
  }

  karst::Decision decide(const karst::Request& request) override {
    std::vector<karst::Goal> goals;
    for (const karst::Frontier& f : request.frontiers) {
      if (!f.reachable() || karst::distance(f.viewpoint, request.position()) < tolerance_m_) continue;
      const double right_rad = angle_to_the_right(request, f.centroid);
      const double score = f.path_length_m <= reach_m_ ? right_rad : -f.path_length_m;
      char why[100];
      std::snprintf(why, sizeof why, "%.0f deg to the right, %.1f m away", right_rad * 57.29578,
                    f.path_length_m);
      karst::Goal goal = karst::goal_at(f, score, why);
      goal.tolerance_m = tolerance_m_;
      goals.push_back(goal);
    }
    if (goals.empty()) return karst::Decision::explored("no frontier can be reached");
    std::sort(goals.begin(), goals.end(), [](const karst::Goal& a, const karst::Goal& b) {
      return a.score != b.score ? a.score > b.score : a.frontier_id < b.frontier_id;
    });
    goals.resize(std::min<std::size_t>(goals.size(), 10));
    return karst::Decision::fly(goals);
  }

 private:
  /// Seen from above: 0 straight ahead, pi/2 to the right, negative to the left.
  static double angle_to_the_right(const karst::Request& request, const karst::Vec3& place) {
    const karst::Vec3 flight = request.direction_of_flight, there = place - request.position();
    return -std::atan2(flight.x * there.y - flight.y * there.x, flight.x * there.x + flight.y * there.y);
  }

  double reach_m_ = 20.0;
  double tolerance_m_ = 0.5;
};

}  // namespace

KARST_POLICY(RightHand, "right_hand", "1.0.0", "Keeps to the right-hand wall.")
