// Where the beams of a Livox Mid-360 point.
//
// Four lasers fire one after another, 5 us apart. A mirror turns them clockwise, 174.5 times a second, and
// each laser's zenith angle swings once a turn, by an amplitude of its own. All of them move slowly up and
// down through the field of view of 59 degrees, 3.65 degrees a turn. The periods have no common multiple
// below twelve hours: the pattern does not repeat in a flight. The numbers were read off the table of
// directions that the maker published for simulators (livox_laser_simulation, mid360.csv), of which only the
// first tenth of a second was looked at. They were not compared with a real unit.
#pragma once
#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"

namespace karst::sim {

constexpr core::TimeNs kMid360Step = 5000;  // ns between two shots

/// Unit vector in the lidar frame of a shot, counted from the clock's zero.
core::Vec3f mid360_direction(std::int64_t shot);

}  // namespace karst::sim
