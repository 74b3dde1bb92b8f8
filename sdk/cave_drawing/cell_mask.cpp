#include "sdk/cave_drawing/cell_mask.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core_stack/common/error.h"

namespace karst::cave_drawing {
namespace {

constexpr std::int64_t kMostCells = 200'000'000;  // 7 km square at half a metre

}  // namespace

CellMask::CellMask(const std::string& file, std::int64_t low_x, std::int64_t low_y, std::int64_t high_x,
                   std::int64_t high_y) {
  const std::int64_t width = high_x - low_x + 1, height = high_y - low_y + 1;
  if (width <= 0 || height <= 0) throw core::InputError(file, "", "there is nothing to draw");
  if (width > kMostCells || height > kMostCells || width * height > kMostCells)
    throw core::InputError(
        file, "", "too large to draw: " + std::to_string(width) + " by " + std::to_string(height) + " cells");
  low_x_ = static_cast<int>(low_x);
  low_y_ = static_cast<int>(low_y);
  width_ = static_cast<int>(width);
  height_ = static_cast<int>(height);
  cells_.assign(static_cast<std::size_t>(width * height), 0);
}

std::size_t CellMask::count() const {
  return static_cast<std::size_t>(std::count(cells_.begin(), cells_.end(), std::uint8_t{1}));
}

CellMask opened(const CellMask& mask) {
  CellMask out("", mask.low_x(), mask.low_y(), mask.high_x(), mask.high_y());
  for (int y = mask.low_y(); y < mask.high_y(); ++y)
    for (int x = mask.low_x(); x < mask.high_x(); ++x)
      if (mask.at(x, y) && mask.at(x + 1, y) && mask.at(x, y + 1) && mask.at(x + 1, y + 1))
        for (int dy = 0; dy < 2; ++dy)
          for (int dx = 0; dx < 2; ++dx) out.set(x + dx, y + dy);
  return out;
}

CellMask without_specks(const CellMask& mask, std::size_t least) {
  // A margin of empty cells joins all that is outside.
  CellMask seen("", mask.low_x() - 1, mask.low_y() - 1, mask.high_x() + 1, mask.high_y() + 1);
  CellMask out = mask;
  std::vector<std::pair<int, int>> wave, next, few;
  for (int y = seen.low_y(); y <= seen.high_y(); ++y)
    for (int x = seen.low_x(); x <= seen.high_x(); ++x) {
      if (seen.at(x, y)) continue;
      const bool full = mask.at(x, y);
      wave.assign(1, {x, y});
      few.clear();
      seen.set(x, y);
      std::size_t size = 0;
      // Wave by wave: of all that is outside of a cave, only an edge is held.
      for (; !wave.empty(); std::swap(wave, next)) {
        size += wave.size();
        if (size < least) few.insert(few.end(), wave.begin(), wave.end());
        next.clear();
        for (const auto& [px, py] : wave)
          for (const auto& [dx, dy] :
               std::array<std::pair<int, int>, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}}) {
            const int nx = px + dx, ny = py + dy;
            if (nx < seen.low_x() || nx > seen.high_x() || ny < seen.low_y() || ny > seen.high_y()) continue;
            if (seen.at(nx, ny) || mask.at(nx, ny) != full) continue;
            seen.set(nx, ny);
            next.emplace_back(nx, ny);
          }
      }
      if (size < least)
        for (const auto& [px, py] : few) out.set(px, py, !full);
    }
  return out;
}

}  // namespace karst::cave_drawing
