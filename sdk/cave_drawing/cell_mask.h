// A bitmap of square cells in a plane: cell (x, y) covers [x, x + 1) and [y, y + 1) cell edges.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace karst::cave_drawing {

class CellMask {
 public:
  /// Of the closed range of cells. Throws core::InputError that names `file` if there are too many.
  CellMask(const std::string& file, std::int64_t low_x, std::int64_t low_y, std::int64_t high_x,
           std::int64_t high_y);

  int low_x() const { return low_x_; }
  int low_y() const { return low_y_; }
  int high_x() const { return low_x_ + width_ - 1; }
  int high_y() const { return low_y_ + height_ - 1; }
  /// Cells outside of the range are empty.
  bool at(int x, int y) const { return is_in(x, y) && cells_[index(x, y)] != 0; }
  /// Cells outside of the range are left out.
  void set(int x, int y, bool full = true) {
    if (is_in(x, y)) cells_[index(x, y)] = full ? 1 : 0;
  }
  std::size_t count() const;

 private:
  bool is_in(int x, int y) const {
    return x >= low_x_ && y >= low_y_ && x - low_x_ < width_ && y - low_y_ < height_;
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - low_y_) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x - low_x_);
  }

  int low_x_ = 0, low_y_ = 0, width_ = 0, height_ = 0;
  std::vector<std::uint8_t> cells_;
};

/// Without what is one cell thin: the union of all squares of two by two cells in it (a morphological
/// opening). What single rays opened goes.
CellMask opened(const CellMask& mask);

/// Full pieces and holes of fewer than `least` cells are taken away.
CellMask without_specks(const CellMask& mask, std::size_t least);

}  // namespace karst::cave_drawing
