#include "core_stack/common/direction_cells.h"

namespace karst::core {

DirectionCells::DirectionCells(std::span<const Vec3f> directions, float cell_rad)
    : cell_rad_(std::max(cell_rad, 0.005f)) {
  const int rows = static_cast<int>(kPi / cell_rad_) + 1;
  std::size_t cells = 0;
  for (int r = 0; r < rows; ++r) {
    const float elevation = (static_cast<float>(r) + 0.5f) * cell_rad_ - kPi / 2;
    const int n = std::max(1, static_cast<int>(2 * kPi * std::cos(elevation) / cell_rad_));
    rows_.push_back({cells, n});
    cells += static_cast<std::size_t>(n);
  }
  // A counting sort: it keeps the order within a cell.
  std::vector<std::uint32_t> cell_of(directions.size());
  begin_.assign(cells + 1, 0);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Vec3f& d = directions[i];
    const Row& row = rows_[static_cast<std::size_t>(row_of(std::asin(std::clamp(d.z(), -1.0f, 1.0f))))];
    cell_of[i] = static_cast<std::uint32_t>(
        row.first_cell + static_cast<std::size_t>(column_of(row, std::atan2(d.y(), d.x()))));
    ++begin_[cell_of[i] + 1];
  }
  for (std::size_t c = 0; c < cells; ++c) begin_[c + 1] += begin_[c];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  order_.resize(directions.size());
  for (std::size_t i = 0; i < directions.size(); ++i)
    order_[next[cell_of[i]]++] = static_cast<std::uint32_t>(i);
}

}  // namespace karst::core
