#include "core_stack/mission/recording/map_cells.h"

#include <bit>
#include <cstring>

namespace karst::core {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is written as the machine has it");

constexpr std::int32_t kWorld = 1 << 15;                // VoxelMap's keys
constexpr std::int32_t kLongest_ms = 2 * 86400 * 1000;  // a day's flight, and a day for a late start

using Numbers = std::array<std::int32_t, 4>;
static_assert(sizeof(Numbers) == MapCellRecord::kBytes);

bool in_world(std::int32_t k) { return k >= -kWorld && k < kWorld; }

}  // namespace

MapCellBytes bytes_of(const MapCellRecord& r) {
  const Numbers numbers{r.key.x, r.key.y, r.key.z, 4 * r.t_ms + static_cast<std::int32_t>(r.cell)};
  MapCellBytes out;
  std::memcpy(out.bytes.data(), numbers.data(), out.bytes.size());
  return out;
}

std::optional<MapCellRecord> map_cell_of(std::string_view bytes) {
  Numbers n{};
  if (bytes.size() != sizeof n) return std::nullopt;
  std::memcpy(n.data(), bytes.data(), sizeof n);
  const std::int32_t t_ms = n[3] / 4, cell = n[3] % 4;
  if (!in_world(n[0]) || !in_world(n[1]) || !in_world(n[2]) || t_ms <= 0 || t_ms > kLongest_ms || cell < 0 ||
      cell > 2)
    return std::nullopt;
  return MapCellRecord{{n[0], n[1], n[2]}, static_cast<Cell>(cell), t_ms};
}

}  // namespace karst::core
