// Is the cave one to fly in? Asked before the flight.
#pragma once
#include <string>

namespace karst::flight {

/// Throws core::InputError with what `karst cave info` would say of a cave that it refuses: the start lies in
/// rock or has no room to fly near it, or free space leads outside the mesh. `start` may be "" for the file's
/// own.
void check_cave(const std::string& cave, const std::string& start);

}  // namespace karst::flight
