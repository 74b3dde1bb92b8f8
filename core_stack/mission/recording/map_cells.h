// map_cells.bin: every change of a cell of the map, of which the map of a flight that was cut off is made.
//
// Records of four little-endian int32: the key x, y, z of a cell, and 4 t + c with the time t in milliseconds
// and its class c from then on: 0 unknown, 1 free, 2 occupied. A record that is written is never zero in its
// fourth number, as no cell changes in the first millisecond: a file system may have left zeros where data
// did not reach the disk before a power cut.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

constexpr const char* kMapCellsName = "map_cells.bin";

struct MapCellRecord {
  static constexpr std::size_t kBytes = 16;
  CellKey key;
  Cell cell = Cell::unknown;
  std::int32_t t_ms = 0;
  bool operator==(const MapCellRecord&) const = default;
};

/// A record as bytes; it converts to std::string_view.
struct MapCellBytes {
  std::array<char, MapCellRecord::kBytes> bytes{};
  operator std::string_view() const { return {bytes.data(), bytes.size()}; }
};
MapCellBytes bytes_of(const MapCellRecord& record);

/// Nothing if no flight wrote these kBytes bytes: zeros, or a key or time out of this world.
std::optional<MapCellRecord> map_cell_of(std::string_view bytes);

}  // namespace karst::core
