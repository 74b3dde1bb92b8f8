// Growth of the map: for each cell, when it became occupied and when it ceased to be (map_growth.bin).
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::evaluation {

/// An interval of time during which a cell was occupied.
struct OccupiedSpan {
  static constexpr std::int32_t kNever = INT32_MAX;
  core::CellKey key;
  std::int32_t from_ms = 0;
  std::int32_t until_ms = kNever;
};

/// Sorted by key, then by time. A file that ends in mid-record is used up to there and reported.
std::vector<OccupiedSpan> read_map_growth(const std::filesystem::path& file,
                                          std::vector<std::string>& problems);

}  // namespace karst::evaluation
