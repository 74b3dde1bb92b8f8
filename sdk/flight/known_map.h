// Reads the map of an earlier flight that a mission names, for the core.
#pragma once
#include "sdk/flight/mission_file.h"

namespace karst::flight {

/// The mission with the map of map.start read, and its digest. The same mission if it names none.
/// Throws core::InputError on a map that cannot be read, that holds no rock or no free space, or that has
/// another digest than the mission says, and for a team.
Mission with_earlier_map(Mission mission);

}  // namespace karst::flight
