// Which of two vehicles gives way.
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
  double reaction_s =
      1.5;  // news are a third of a second old and sometimes a second, and a brake takes its time to begin
  double own_s = 0.3;  // the brake alone
  double brake_mps2 = 1.0;
};

/// The distance below which one of the two has to stop: what is kept, and what both need to stop if they
/// approach.
double yield_distance_m(const SeparationRule& rule, const Neighbour& a, const Neighbour& b);
/// The distance below which both stop, whoever goes first.
double stop_distance_m(const SeparationRule& rule, const Neighbour& a, const Neighbour& b);

/// Whether `self` on its way to make room has to stop for this one: it flies towards it, and what both need
/// to stop would leave less than half the distance that is kept; of one that it makes room for, and that
/// stops for it, what it needs itself. Not for one that waits aside, and is an obstacle in the map.
bool stops_on_the_way(const SeparationRule& rule, const Neighbour& self, const Neighbour& other,
                      bool makes_room_for_it);

/// Speed at which the distance shrinks; negative if it grows.
double closing_mps(const Neighbour& a, const Neighbour& b);

/// Whether a goes before b: one order of all vehicles, so no two both go first and no three wait in a circle.
/// First who takes off or lands, and cannot stop; then who has nowhere to make room; who goes home, whose
/// time is short; who explores; last who waits aside. Of two alike the lower number: it started first, and
/// has less time left.
bool goes_before(const Neighbour& a, const Neighbour& b);

/// The others that a vehicle has to stop for: those too near that go before it, and those that both stop for.
/// Not those that wait aside: they stand still, and are obstacles in the map.
std::vector<Neighbour> give_way_to(const SeparationRule& rule, const Neighbour& self,
                                   const std::vector<Neighbour>& others);

}  // namespace karst::core
