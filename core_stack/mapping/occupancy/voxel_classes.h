// A map's blocks by class only: what of it goes to other processes and into records.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// A block of 8 x 8 x 8 cells.
struct ClassBlock {
  CellKey low;                            // a multiple of 8 in each axis
  std::array<std::uint8_t, 128> classes;  // two bits a cell, lowest first; x fastest, then y
};
/// The block lies in the world and holds classes only.
bool is_sound(const ClassBlock& block);

/// Blocks in which a cell's class changed after write number `since` (0: all that were written to), sorted.
std::vector<ClassBlock> blocks_changed_after(const VoxelMap& map, std::uint64_t since);

/// Gives the cells of sound blocks these classes, at one log-odds each way, and the map the number of the
/// write they come from. Returns the cells whose class changed, sorted by key.
std::vector<CellChange> assign_blocks(VoxelMap& map, std::span<const ClassBlock> blocks,
                                      std::uint64_t revision);

}  // namespace karst::core
