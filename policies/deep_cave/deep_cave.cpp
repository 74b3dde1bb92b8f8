// Flies as deep into the cave as half of the battery allows.
#include <karst/expected_gain.h>
#include <karst/ranking.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

namespace {

class DeepCave : public karst::Policy {
 public:
  DeepCave() {
    ranking_.path_weight = 0.0;  // the path's cost is contained in the depth that can still be reached
    ranking_.horizon_m = 1000.0;
    ranking_.turn_cost_m = 4.0;
    ranking_.keep_bonus_m = 6.0;
  }

  void parameters(karst::Parameters& p) override {
    p.add("reach", reach_m_, "m", 0, 10000, "a passage is not expected to go on for longer than this");
    p.add("even_volume", even_volume_m3_, "m^3", 0.1, 1000,
          "a frontier that shows so much unknown space goes on with a chance of one half");
    p.add("cruise", cruise_, "", 0.1, 1, "mean speed of a flight, as a share of the greatest");
    gain_.parameters(p);
    ranking_.parameters(p);
  }

  karst::Decision decide(const karst::Request& request) override {
    if (!home_) home_ = request.position();
    const std::map<std::uint32_t, Prospect> prospects = prospects_of(request);
    return ranking_.decide(request, [&](const karst::Frontier& f) {
      const Prospect& p = prospects.at(f.id);
      char why[160];
      std::snprintf(why, sizeof why, "%.0f m deep, may lead %.0f m deeper with a chance of %.2f, %.1f m away",
                    p.depth_m, p.deeper_m, p.chance, f.path_length_m);
      return karst::Merit{p.depth_m + p.chance * p.deeper_m, why};
    });
  }

  void on_event(const karst::Event& event) override { ranking_.on_event(event); }

 private:
  struct Prospect {
    double depth_m = 0;   // length of the path from the start to the viewpoint
    double deeper_m = 0;  // further depth that the time left would allow from there
    double chance = 0;    // probability that the cave continues there
  };

  /// The prospect of every reachable frontier. Each second flown deeper costs another one on the flight home.
  std::map<std::uint32_t, Prospect> prospects_of(const karst::Request& request) {
    std::vector<const karst::Frontier*> reachable;
    std::vector<karst::Vec3> places;
    for (const karst::Frontier& f : request.frontiers)
      if (f.reachable()) {
        reachable.push_back(&f);
        places.push_back(f.viewpoint);
      }
    places.push_back(request.position());
    std::vector<double> depths_m = request.path_lengths(*home_, places, request.clearance_m);
    for (std::size_t i = 0; i < depths_m.size(); ++i)
      if (!std::isfinite(depths_m[i])) depths_m[i] = karst::distance(*home_, places[i]);
    const std::vector<double> volumes_m3 = gain_.volumes_m3(request, reachable);
    const double speed_mps = cruise_ * request.max_speed_mps;
    std::map<std::uint32_t, Prospect> out;
    for (std::size_t i = 0; i < reachable.size(); ++i) {
      const double detour_m = reachable[i]->path_length_m + depths_m[i] - depths_m.back();
      const double left_m = request.seconds_before_homing * speed_mps - detour_m;
      out[reachable[i]->id] = {depths_m[i], std::clamp(left_m / 2, 0.0, reach_m_),
                               volumes_m3[i] / (volumes_m3[i] + even_volume_m3_)};
    }
    return out;
  }

  std::optional<karst::Vec3> home_;  // position of the first decision
  double reach_m_ = 80.0;
  double even_volume_m3_ = 10.0;
  double cruise_ = 0.75;
  karst::ExpectedGain gain_;
  karst::Ranking ranking_;
};

}  // namespace

KARST_POLICY(DeepCave, "deep_cave", "1.1.0",
             "Goes as deep as the time left allows: the way home takes the other half of the battery.")
