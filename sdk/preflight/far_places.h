// The shortest ways from the start through a cave: how far they lead, and which of them the vehicle would
// refuse as climbs that no sensor of it covers.
#pragma once
#include <string>

#include "core_stack/mission/decision/visibility.h"
#include "sdk/selection/free_space.h"

namespace karst::preflight {

struct FarPlaces {
  double farthest_m = 0;      // length of the longest of the shortest ways
  double blind_fraction = 0;  // of about 400 places, those whose shortest way is such a climb
  std::string blind_climb;    // the reason against the shortest of these ways; "" if there is none
};

/// Ways lead through the centres of cells and are up to 5 % too long.
FarPlaces far_places(const selection::FreeSpace& space, const core::Vec3& start,
                     const core::SteepestView& view);

}  // namespace karst::preflight
