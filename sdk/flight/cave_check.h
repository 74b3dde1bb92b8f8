// Checks before the flight that the cave can be flown in.
#pragma once
#include <string>

namespace karst::flight {

/// Throws core::InputError with the message of `karst cave info` for a cave that it refuses: the start lies
/// in rock or has no free space near it, or free space leads outside the mesh. If `start` is "", the file's
/// own start is used.
void check_cave(const std::string& cave, const std::string& start);

}  // namespace karst::flight
