// The clouds in the cave's air at a given time: the cave's own clouds, haze, mist around the vehicle, and the
// dust that its rotors raise.
//
// The wash leaves the rotors as one turbulent jet: it keeps its speed for about 2.5 vehicle diameters, beyond
// which the speed falls as 1 / distance (Bauersfeld et al., Robotics meets fluid dynamics, arXiv:2403.13321,
// 2024). Where it meets rock it lifts dust in proportion to u^2 - u_t^2, u_t the threshold speed that lifts
// dust (as in models of brownout, Phillips and Brown, 64th AHS Forum, 2008); here u_t is given by the
// distance at which the jet has slowed to it. Along walls beside the vehicle flows only recirculated air, at
// half the speed. Every half a second a puff rises from the rock; it spreads, thins and settles.
#pragma once
#include <deque>

#include "core_stack/common/options.h"
#include "plugins/simulator/cave/cave.h"

namespace karst::sim {

struct AirOptions {
  double haze_1pm = 0;                     // everywhere
  double mist_1pm = 0, mist_radius_m = 1;  // of droplets, around the vehicle in flight
  double stirred_1pm = 0;                  // of a fresh puff of dust below the vehicle's full wash
  double stirred_reach_m = 3, settling_s = 4;
};
void describe(core::OptionTable& t, AirOptions& o);

/// Fraction of the full wash's dust that is lifted from rock at this distance, 0..1.
double lifted_fraction(double distance_m, double reach_m, double vehicle_radius_m);

class CaveAir {
 public:
  CaveAir(const AirOptions& o, std::vector<cave::Cloud> clouds, double vehicle_radius_m);

  static constexpr double kPuffPeriod_s = 0.5;
  /// Lifts a puff of dust off the rock that the wash meets; call it once every kPuffPeriod_s of flight.
  void stir(double t_s, const core::Pose& T_world_body, const cave::RayScene& scene);
  std::vector<cave::Cloud> present(double t_s, const core::Vec3& vehicle, bool airborne) const;

 private:
  struct Puff {
    double born_s = 0;
    core::Vec3 position = core::Vec3::Zero();
    double extinction_1pm = 0;
  };

  AirOptions options_;
  std::vector<cave::Cloud> clouds_;
  double vehicle_radius_m_;
  std::deque<Puff> puffs_;
};

}  // namespace karst::sim
