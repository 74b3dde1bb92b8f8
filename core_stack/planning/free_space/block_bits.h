// Sets of cells in a block of 4 x 4 x 4 as 64 bits: growing and splitting them takes a few shifts.
// Bit index: x | y << 2 | z << 4.
#pragma once
#include <cstdint>

namespace karst::core {

using BlockBits = std::uint64_t;

constexpr BlockBits kLowX = 0x1111111111111111u, kHighX = kLowX << 3;
constexpr BlockBits kLowY = 0x000f000f000f000fu, kHighY = kLowY << 12;
constexpr BlockBits kLowZ = 0xffffu, kHighZ = kLowZ << 48;

constexpr BlockBits grown_x(BlockBits b) { return b | (b & ~kHighX) << 1 | (b & ~kLowX) >> 1; }
constexpr BlockBits grown_y(BlockBits b) { return b | (b & ~kHighY) << 4 | (b & ~kLowY) >> 4; }
constexpr BlockBits grown_z(BlockBits b) { return b | b << 16 | b >> 16; }

/// The 26-connected component of `cells` that holds its lowest bit.
constexpr BlockBits first_component(BlockBits cells) {
  BlockBits part = cells & (~cells + 1), before = 0;
  while (part != before) {
    before = part;
    part = grown_x(grown_y(grown_z(part))) & cells;
  }
  return part;
}

/// The cells of the neighbouring block in direction (dx, dy, dz), each -1, 0 or 1, that touch a cell of `b`
/// by a face, an edge or a corner.
constexpr BlockBits touched_in_neighbour(BlockBits b, int dx, int dy, int dz) {
  b = dx == 0 ? grown_x(b) : dx > 0 ? (b & kHighX) >> 3 : (b & kLowX) << 3;
  b = dy == 0 ? grown_y(b) : dy > 0 ? (b & kHighY) >> 12 : (b & kLowY) << 12;
  return dz == 0 ? grown_z(b) : dz > 0 ? (b & kHighZ) >> 48 : (b & kLowZ) << 48;
}

}  // namespace karst::core
