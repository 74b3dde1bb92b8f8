// A cell's three coordinates in one word, 21 bits each, for hash tables and ray traversal.
//
// x is in the highest bits, so that numeric order equals the order of CellKey. Clearing the lowest three bits
// of each part gives the cell's block of 8x8x8.
#pragma once
#include <cstdint>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

using PackedCell = std::uint64_t;

constexpr std::int32_t kPackedLimit = 1 << 20;  // coordinates lie in [-kPackedLimit, kPackedLimit)
constexpr int kShiftX = 42, kShiftY = 21;
constexpr PackedCell kInBlock = PackedCell{7} << kShiftX | PackedCell{7} << kShiftY | 7;

constexpr PackedCell pack(const CellKey& k) {
  const auto part = [](std::int32_t v) { return static_cast<PackedCell>(v + kPackedLimit); };
  return part(k.x) << kShiftX | part(k.y) << kShiftY | part(k.z);
}
constexpr CellKey unpack(PackedCell p) {
  const auto part = [p](int shift) {
    return static_cast<std::int32_t>(p >> shift & 0x1fffff) - kPackedLimit;
  };
  return {part(kShiftX), part(kShiftY), part(0)};
}

/// Position of a cell in its block: one word per z, in it one bit per x and y, x fastest.
constexpr std::uint32_t word_in_block(PackedCell p) { return static_cast<std::uint32_t>(p & 7); }
constexpr std::uint32_t bit_in_block(PackedCell p) {
  return static_cast<std::uint32_t>((p >> kShiftX & 7) | (p >> (kShiftY - 3) & 0x38));
}

/// Hashes a word to one of a table's slots (a power of two). Neighbouring cells must not get neighbouring
/// slots, or linear probing would walk through all of them.
constexpr std::size_t slot_of(std::uint64_t word, std::size_t slots) {
  word *= 0x9e3779b97f4a7c15ull;
  word = (word ^ word >> 32) * 0xbf58476d1ce4e5b9ull;
  return (word >> 32) & (slots - 1);
}

}  // namespace karst::core
