// Chooses the frontier with the shortest path, with a preference for open space and against turning back.
#include <karst/ranking.h>

#include <cstdio>

namespace {

class NearestFrontier : public karst::Policy, public karst::Restorable {
 public:
  NearestFrontier() { ranking_.turn_cost_m = 6.0; }

  void parameters(karst::Parameters& p) override {
    p.add("opening_bonus", opening_bonus_m_, "m", 0, 100,
          "worth of a frontier with nothing but unknown around it; in part for less");
    ranking_.parameters(p);
  }

  karst::Decision decide(const karst::Request& request) override {
    return ranking_.decide(request, [&](const karst::Frontier& f) {
      const double all = f.unknown_cells + static_cast<double>(f.free_cells);
      const double unknown_fraction = all > 0 ? f.unknown_cells / all : 0.0;
      char why[120];
      std::snprintf(why, sizeof why, "%.1f m away, %.0f %% unknown around it", f.path_length_m,
                    100.0 * unknown_fraction);
      return karst::Merit{opening_bonus_m_ * unknown_fraction, why};
    });
  }

  void on_event(const karst::Event& event) override { ranking_.on_event(event); }
  void memory(karst::Memory& m) override { ranking_.memory(m); }

 private:
  double opening_bonus_m_ = 3.0;
  karst::Ranking ranking_;
};

}  // namespace

KARST_POLICY(NearestFrontier, "nearest_frontier", "1.0.0",
             "Flies to the frontier with the shortest way to it.")
