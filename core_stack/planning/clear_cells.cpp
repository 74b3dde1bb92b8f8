// Which cells are clear, for whole tiles at once: a ball of free cells around each, by shifts of rows of
// bits.
#include <algorithm>
#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/planning/free_tiles.h"

namespace karst::core {
namespace {

constexpr int kMostReach = 16;  // a row of 32 cells is widened by that much on both sides

/// True if the ball of radius r around one end or the other of the move from 0 to d holds o, or no point of
/// the move is nearer to o than r.
bool ends_cover(const Eigen::Vector3i& o, const Eigen::Vector3i& d, double r2) {
  const double o2 = o.squaredNorm(), along = o.dot(d), d2 = d.squaredNorm();
  if (along <= 0 || along >= d2) return true;
  return o2 - along * along / d2 >= r2 || o2 - 2 * along + d2 < r2;
}

bool in_ball(const Eigen::Vector3i& o, double r2) {
  if (o.squaredNorm() < r2) return true;
  for (int i = 0; i < 27; ++i)
    if (!ends_cover(o, {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}, r2)) return true;
  return false;
}

/// Rows of a tile and of `margin` more around it in y and z, as 64 bits with the tile's first cell at bit 16.
struct WideRows {
  int margin, n;
  std::vector<std::uint64_t> rows;

  explicit WideRows(int m) : margin(m), n(8 + 2 * m), rows(static_cast<std::size_t>(n * n)) {}
  std::uint64_t& at(int y, int z) { return rows[static_cast<std::size_t>((z + margin) * n + y + margin)]; }
  std::uint64_t at(int y, int z) const {
    return rows[static_cast<std::size_t>((z + margin) * n + y + margin)];
  }
};

/// Cells whose neighbours up to w on both sides along x are free, for w = 0, 1, ...
std::vector<WideRows> eroded_along_x(WideRows free, int most) {
  std::vector<WideRows> out{std::move(free)};
  for (int w = 1; w <= most; ++w) {
    WideRows e = out.back();
    for (std::size_t i = 0; i < e.rows.size(); ++i) {
      const std::uint64_t row = out.front().rows[i];
      e.rows[i] &= (row << w) & (row >> w);
    }
    out.push_back(std::move(e));
  }
  return out;
}

/// Cells of the row (y, z) around which the ball is free.
std::uint64_t fitting(const std::vector<WideRows>& eroded, const Ball& ball, int y, int z) {
  std::uint64_t fits = ~std::uint64_t{0};
  for (const Ball::Row& r : ball.rows()) {
    const std::uint64_t row = eroded[static_cast<std::size_t>(r.half_width)].at(y + r.dy, z + r.dz);
    fits &= ball.shift() & 1 ? row & row >> 1 : row;
  }
  return fits;
}

}  // namespace

Ball::Ball(double radius_cells, int shift) : shift_(shift) {
  const double r2 = radius_cells * radius_cells - 1e-6;
  const int n = static_cast<int>(std::ceil(radius_cells)) + 1;
  const double sx = 0.5 * (shift & 1), sy = 0.5 * (shift >> 1 & 1), sz = 0.5 * (shift >> 2 & 1);
  const auto holds = [&](int dx, int dy, int dz) {
    return shift == 0 ? in_ball({dx, dy, dz}, r2) : (Vec3(dx, dy, dz) - Vec3(sx, sy, sz)).squaredNorm() < r2;
  };
  for (int dz = -n; dz <= n; ++dz)
    for (int dy = -n; dy <= n; ++dy) {
      int half_width = -1;
      for (int dx = 0; dx <= n; ++dx)
        if (holds(-dx, dy, dz)) half_width = dx;                 // on the side away from the shift
      if (half_width < 0 && dy == 0 && dz == 0) half_width = 0;  // the cell itself must be free
      if (half_width < 0) continue;
      rows_.push_back({dy, dz, half_width});
      reach_ = std::max({reach_, half_width + (shift & 1), std::abs(dy), std::abs(dz)});
    }
}

ClearanceRule::ClearanceRule(double clearance_cells) {
  if (!(clearance_cells <= kMostReach - 2))
    throw InputError("planning", "clearance",
                     "is more than 14 cells of the map; make it less or the cells larger");
  balls_.emplace_back(clearance_cells);
}

ClearanceRule::ClearanceRule(double clearance_cells, double search_cells) : ClearanceRule(clearance_cells) {
  balls_.emplace_back(search_cells);
  for (int shift = 1; shift < 8; ++shift) shifted_.emplace_back(clearance_cells, shift);
}

int ClearanceRule::reach() const {
  int reach = std::max(balls_.front().reach(), balls_.back().reach());
  for (const Ball& b : shifted_) reach = std::max(reach, b.reach() + 1);
  return reach;
}

TileBits FreeTiles::clear_cells(const TileKey& t, const ClearanceRule& rule) const {
  TileBits out = bits(t);
  if (std::all_of(out.begin(), out.end(), [](std::uint32_t r) { return r == 0; })) return out;
  const int p = rule.reach();
  const CellKey c = corner_of(t);
  WideRows free(p);
  for (int z = -p; z < 8 + p; ++z)
    for (int y = -p; y < 8 + p; ++y)
      free.at(y, z) = std::uint64_t{row(c.x - 16, c.y + y, c.z + z)} |
                      std::uint64_t{row(c.x + 16, c.y + y, c.z + z)} << 32;
  const std::vector<WideRows> eroded = eroded_along_x(std::move(free), p);

  TileBits tight{};  // clear by the search's clearance only
  bool any_tight = false;
  for (int z = 0; z < 8; ++z)
    for (int y = 0; y < 8; ++y) {
      std::uint32_t& result = out[row_of(y, z)];
      if (result == 0) continue;
      const std::uint32_t before = result;
      result = static_cast<std::uint32_t>(fitting(eroded, rule.ball(), y, z) >> 16);
      if (rule.shifted().empty() || result == before) continue;
      tight[row_of(y, z)] =
          static_cast<std::uint32_t>(fitting(eroded, rule.search_ball(), y, z) >> 16) & ~result;
      any_tight |= tight[row_of(y, z)] != 0;
    }
  if (!any_tight) return out;
  // The point half a cell up from k is half a cell down from the next cell: each counts for both, in each
  // axis.
  for (const Ball& ball : rule.shifted())
    for (int z = ball.shift() & 4 ? -1 : 0; z < 8; ++z)
      for (int y = ball.shift() & 2 ? -1 : 0; y < 8; ++y) {
        std::uint64_t fits = fitting(eroded, ball, y, z);
        if (ball.shift() & 1) fits |= fits << 1;
        const auto cells = static_cast<std::uint32_t>(fits >> 16);
        for (int up_z = 0; up_z <= (ball.shift() >> 2 & 1); ++up_z)
          for (int up_y = 0; up_y <= (ball.shift() >> 1 & 1); ++up_y)
            if (y + up_y >= 0 && y + up_y < 8 && z + up_z >= 0 && z + up_z < 8)
              out[row_of(y + up_y, z + up_z)] |= tight[row_of(y + up_y, z + up_z)] & cells;
      }
  return out;
}

}  // namespace karst::core
