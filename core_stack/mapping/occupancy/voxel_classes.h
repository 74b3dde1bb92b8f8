// A map's blocks by class only: the form sent to other processes and written to records.
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
  std::array<std::uint8_t, 128> classes;  // two bits per cell, lowest first; x fastest, then y
};
/// Whether the block lies within the world and all its classes are valid.
bool is_sound(const ClassBlock& block);

/// Blocks in which a cell's class changed after write `since` (0: all blocks ever written), sorted.
std::vector<ClassBlock> blocks_changed_after(const VoxelMap& map, std::uint64_t since);

/// Gives the cells of sound blocks these classes, with one fixed log-odds each for free and occupied, and
/// sets the map's revision to that of the blocks. Returns the cells whose class changed, sorted by key.
std::vector<CellChange> assign_blocks(VoxelMap& map, std::span<const ClassBlock> blocks,
                                      std::uint64_t revision);

}  // namespace karst::core
