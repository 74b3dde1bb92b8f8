// What a run directory says of a flight, for its drawings.
#pragma once
#include <filesystem>

#include "sdk/cave_drawing/map_drawings.h"

namespace karst::cave_drawing {

/// The cave's name from mission.info, the flown path from trajectory.tum, the entrance where that begins, and
/// the finds from objects.json. What is missing is left out: a map alone can be drawn. A run holds no date.
FlightRecord flight_record(const std::filesystem::path& run);

}  // namespace karst::cave_drawing
