// The map of a flight that was cut off, of map_cells.bin (core_stack/mission/recording/map_cells.h).
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::evaluation {

/// The map as of the last record. As in a .bt file, each known cell has the log-odds of MapOptions' limits.
/// None if there is no file, or nothing in it. A record that is cut off, or that no flight wrote, is left out
/// and reported.
std::optional<core::VoxelMap> read_map_cells(const std::filesystem::path& file, double resolution_m,
                                             std::vector<std::string>& problems);

}  // namespace karst::evaluation
