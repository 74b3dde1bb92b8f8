// Chooses the highest frontier first (trial C of the paper): for shafts, chimneys and high chambers.
#include <karst/ranking.h>

#include <cstdio>

namespace {

class HighestFrontier : public karst::Policy, public karst::Restorable {
 public:
  HighestFrontier() {
    ranking_.path_weight = 0.5;
    ranking_.turn_cost_m = 2.0;
  }

  void parameters(karst::Parameters& p) override {
    p.add("climb_worth", climb_worth_, "", 0, 1000, "metres of worth for a metre of height");
    ranking_.parameters(p);
  }

  karst::Decision decide(const karst::Request& request) override {
    return ranking_.decide(request, [&](const karst::Frontier& f) {
      const double above_m = f.centroid.z - request.position().z;
      char why[120];
      std::snprintf(why, sizeof why, "%.1f m %s the vehicle, %.1f m away", std::abs(above_m),
                    above_m < 0 ? "below" : "above", f.path_length_m);
      return karst::Merit{climb_worth_ * f.centroid.z, why};
    });
  }

  void on_event(const karst::Event& event) override { ranking_.on_event(event); }
  void memory(karst::Memory& m) override { ranking_.memory(m); }

 private:
  double climb_worth_ = 5.0;
  karst::Ranking ranking_;
};

}  // namespace

KARST_POLICY(HighestFrontier, "highest_frontier", "1.0.0",
             "Flies to the highest frontier within its horizon.")
