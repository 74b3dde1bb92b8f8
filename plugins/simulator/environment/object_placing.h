// Objects of interest placed in a cave at random, where a vehicle can see them.
#pragma once
#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/environment/object_options.h"

namespace karst::sim {

/// Positions at least `clearance_m` from rock, on a grid of 0.3 m (or the clearance if that is less), that
/// can be reached from the start with nearly that clearance: the nearest half million, by number of grid
/// steps. World frame, m.
std::vector<core::Vec3> flyable_places(const cave::Cave& cave, double clearance_m = 0.4);

/// Adds `o.count` objects to the cave's own: each on rock within 4 m and in sight of a flyable position, seen
/// from it at most 60 degrees off the rock's normal; at least 4 m from each other and from the start.
/// The same `seed` and cave give the same objects. Throws InputError if there is no room for so many.
void place_objects(cave::Cave& cave, const ObjectOptions& o, std::uint64_t seed);

}  // namespace karst::sim
