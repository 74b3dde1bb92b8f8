// The frontier closest to the lateral direction of flight (trials A and B of the paper).
//
// "Lateral" is read as horizontal: the frontier whose bearing deviates least from the direction of flight,
// seen from above. That drives the vehicle deep into the cave without turning back, as in those trials.
// `side` chooses the other reading: the direction perpendicular to the flight.
#include <karst/ranking.h>

#include <cmath>
#include <cstdio>

namespace {

constexpr double kPi = 3.14159265358979323846;

class LateralFrontier : public karst::Policy, public karst::Restorable {
 public:
  LateralFrontier() {
    ranking_.path_weight = 0.5;
    ranking_.turn_cost_m = 0.0;  // deviation is charged below
  }

  void parameters(karst::Parameters& p) override {
    p.add("side", side_, "ahead|left|right|sideways",
          "the direction preferred, relative to the flight seen from above; sideways: left or right");
    p.add("deviation_cost", deviation_cost_m_, "m", 0, 1000,
          "what flying against the preferred direction costs; half of it at right angles");
    ranking_.parameters(p);
  }

  karst::Decision decide(const karst::Request& request) override {
    return ranking_.decide(request, [&](const karst::Frontier& f) {
      const double angle = deviation_rad(request, f);
      char why[120];
      std::snprintf(why, sizeof why, "%.0f deg off the preferred direction (%s), %.1f m away",
                    angle * 180.0 / kPi, side_.c_str(), f.path_length_m);
      return karst::Merit{-deviation_cost_m_ * angle / kPi, why};
    });
  }

  void on_event(const karst::Event& event) override { ranking_.on_event(event); }
  void memory(karst::Memory& m) override { ranking_.memory(m); }

 private:
  /// 0: exactly in the preferred direction, pi: opposite to it. A frontier straight above or below has no
  /// bearing and counts as perpendicular.
  double deviation_rad(const karst::Request& request, const karst::Frontier& f) const {
    const karst::Vec3 flight = request.direction_of_flight;
    const karst::Vec3 there = f.centroid - request.position();
    constexpr double min_horizontal = 1e-3;
    if (std::hypot(flight.x, flight.y) < min_horizontal || std::hypot(there.x, there.y) < 0.5) return kPi / 2;
    const double bearing =
        std::atan2(flight.x * there.y - flight.y * there.x, flight.x * there.x + flight.y * there.y);
    if (side_ == "ahead") return std::abs(bearing);
    const double off_left = std::abs(std::remainder(bearing - kPi / 2, 2 * kPi));
    const double off_right = std::abs(std::remainder(bearing + kPi / 2, 2 * kPi));
    if (side_ == "left") return off_left;
    if (side_ == "right") return off_right;
    return std::min(off_left, off_right);
  }

  std::string side_ = "ahead";
  double deviation_cost_m_ = 30.0;
  karst::Ranking ranking_;
};

}  // namespace

KARST_POLICY(LateralFrontier, "lateral_frontier", "1.0.0",
             "Keeps its horizontal direction: the frontier least off it comes first.")
