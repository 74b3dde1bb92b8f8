// Separation and right of way: which of two vehicles gives way, and at what distance.
#pragma once
#include <vector>

#include "core_stack/team/communication/messages.h"

namespace karst::core {

/// A vehicle in the air; another one as last heard, or seen, and brought up to now.
struct Neighbour {
  RobotId robot = 0;
  Vec3 position = Vec3::Zero(), velocity_mps = Vec3::Zero();
  TeamPhase phase = TeamPhase::explore;
  double age_s = 0;   // since it was told
  bool heard = true;  // or else seen only
};

struct SeparationRule {
  double distance_m = 3.0;
  double reaction_s = 1.5;  // a state is 0.3 s old, sometimes 1 s; braking takes another moment to begin
  double own_s = 0.3;       // the latency of its own braking
  double brake_mps2 = 1.0;
};

/// The distance below which one of the two must stop: the separation, plus the braking distance of both if
/// they approach each other.
double yield_distance_m(const SeparationRule& rule, const Neighbour& a, const Neighbour& b);
/// The distance below which both stop, whichever has the right of way.
double stop_distance_m(const SeparationRule& rule, const Neighbour& a, const Neighbour& b);

/// Whether `self`, while it flies to its waiting place, must stop for `other`: it approaches, and after both
/// have braked less than half the separation would remain. A vehicle that waits aside is an obstacle in the
/// map, and `self` does not stop for it.
bool stops_on_the_way(const SeparationRule& rule, const Neighbour& self, const Neighbour& other);

/// Closing speed; negative if the distance grows.
double closing_mps(const Neighbour& a, const Neighbour& b);

/// Whether a has the right of way over b. This is a strict total order of all vehicles, so no two both go
/// first and no cycle of vehicles waits for each other. Highest rank: a vehicle that takes off or lands, as
/// it cannot stop. Then a vehicle without a waiting place, one that is seen to fly and not heard, one that
/// flies home and is short of time, one that explores, and last one that waits aside. At equal rank the lower
/// number goes first: it started first and has less time left.
bool goes_before(const Neighbour& a, const Neighbour& b);

/// The vehicles that `self` must stop for: those too near that have the right of way, and those so near that
/// both stop. Vehicles that wait aside are left out: they hover, and are obstacles in the map.
std::vector<Neighbour> give_way_to(const SeparationRule& rule, const Neighbour& self,
                                   const std::vector<Neighbour>& others);

}  // namespace karst::core
