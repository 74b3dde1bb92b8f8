// Checks before the flight that the cave can be flown in.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core_stack/vehicle/mesh_keys.h"

namespace karst::flight {

/// Throws core::InputError with the message of `karst cave info` for a cave that it refuses: there is no
/// start, the start lies in rock or has no free space near it, or free space leads outside the mesh. The
/// message names what helps, as far as that is known: keys of the mesh, a start. If `start` is "", the file's
/// own start is used. Returns what the mesh suggests though the cave can be flown in, such as another axis
/// that points up. A cave found good is noted in the folder `cache`, unless that is "": with the same files
/// and start it is not looked at again.
std::vector<std::string> check_cave(const std::string& cave, const std::string& start,
                                    const core::MeshKeys& mesh = {}, const std::filesystem::path& cache = {});

}  // namespace karst::flight
