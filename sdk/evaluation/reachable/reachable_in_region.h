// The part of a cave that a mission may explore: coverage is a fraction of it.
#pragma once
#include "core_stack/mapping/region/flight_region.h"
#include "sdk/evaluation/reachable/reachable.h"

namespace karst::evaluation {

/// What is left of `all` for a vehicle that starts at `start` and keeps to the region:
/// - flyable: flyable cells with a centre at least the margin and the clearance inside, 6-connected to the
/// one
///   nearest to the start, and no farther from that one than the greatest path length home, in steps between
///   26 neighbours;
/// - reachable: free cells with a centre in the region that are flyable or seen from there as before.
/// Throws InputError naming `name` if nothing flyable is left within 3 m of the start.
Reachable reachable_in_region(const Reachable& all, const core::FlightRegion& region, const core::Vec3& start,
                              const std::string& name);

}  // namespace karst::evaluation
