// Objects of interest laid out in a cave by chance, where a vehicle can come to see them.
#pragma once
#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/environment/object_options.h"

namespace karst::sim {

/// Places in the air at least `clearance_m` from rock, on a grid of 0.3 m (or the clearance if that is less),
/// that a way with nearly that clearance leads to from the start: the nearest half million by steps of the
/// grid.
std::vector<core::Vec3> flyable_places(const cave::Cave& cave, double clearance_m = 0.4);

/// Adds `o.count` objects to the cave's own: each on rock in sight of a flyable place, within 4 m of it, seen
/// from it at no more than 60 degrees off the rock's normal; 4 m at least from each other and from the start.
/// The same `seed` and cave give the same objects. Throws InputError if there is no room for so many.
void place_objects(cave::Cave& cave, const ObjectOptions& o, std::uint64_t seed);

}  // namespace karst::sim
