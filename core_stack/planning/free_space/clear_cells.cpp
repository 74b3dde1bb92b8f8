// Computes the clear cells of whole tiles at once: erodes free space by a ball, with shifts of rows of
// bits.
#include <algorithm>
#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/planning/free_space/free_tiles.h"

namespace karst::core {
namespace {

constexpr int kMaxExtent = 16;  // a row of 32 cells is extended by this much on both sides

/// True if a ball of radius r around either end of the move from 0 to d contains o, or if no point of the
/// move is nearer to o than r.
bool ends_cover(const Eigen::Vector3i& o, const Eigen::Vector3i& d, double r2) {
  const double o2 = o.squaredNorm(), along = o.dot(d), d2 = d.squaredNorm();
  if (along <= 0 || along >= d2) return true;
  return o2 - along * along / d2 >= r2 || o2 - 2 * along + d2 < r2;
}

bool near_moves(const Eigen::Vector3i& o, double r2) {
  if (o.squaredNorm() < r2) return true;
  for (int i = 0; i < 27; ++i)
    if (!ends_cover(o, {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}, r2)) return true;
  return false;
}

/// An obstacle exactly at the radius, up to rounding, does not count as nearer.
double squared_radius(double radius_cells) { return radius_cells * radius_cells - 1e-6; }

double checked(double clearance_cells) {
  if (!(clearance_cells <= kMaxExtent - 2))
    throw InputError("planning", "clearance",
                     "is more than 14 cells of the map; make it less or the cells larger");
  return clearance_cells;
}

/// Rows of a tile and of a `margin` around it in y and z, as 64 bits with the tile's first cell at bit 16.
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

/// Those `wanted` cells of the row (y, z) around which the ball is free.
std::uint64_t fitting(const std::vector<WideRows>& eroded, const Ball& ball, int y, int z,
                      std::uint64_t wanted) {
  for (const Ball::Row& r : ball.rows()) {
    const std::uint64_t row = eroded[static_cast<std::size_t>(r.half_width)].at(y + r.dy, z + r.dz);
    wanted &= ball.shift() & 1 ? row & row >> 1 : row;
    if (wanted == 0) break;
  }
  return wanted;
}

/// Converts a tile's row to bits of a wide row, and back.
std::uint64_t widened(std::uint32_t row) { return std::uint64_t{row} << 16; }
std::uint32_t narrowed(std::uint64_t row) { return static_cast<std::uint32_t>(row >> 16); }

}  // namespace

template <class Holds>
void Ball::fill(double radius_cells, Holds&& holds) {
  const int n = static_cast<int>(std::ceil(radius_cells)) + 1;
  for (int dz = -n; dz <= n; ++dz)
    for (int dy = -n; dy <= n; ++dy) {
      int half_width = -1;
      for (int dx = 0; dx <= n; ++dx)
        if (holds(Eigen::Vector3i(-dx, dy, dz))) half_width = dx;  // on the side away from the shift
      if (half_width < 0 && dy == 0 && dz == 0) half_width = 0;    // the cell itself must be free
      if (half_width < 0) continue;
      rows_.push_back({dy, dz, half_width});
      extent_ = std::max({extent_, half_width + (shift_ & 1), std::abs(dy), std::abs(dz)});
    }
}

Ball::Ball(double radius_cells, int shift) : shift_(shift) {
  const Vec3 center = 0.5 * Vec3(shift & 1, shift >> 1 & 1, shift >> 2 & 1);
  const double r2 = squared_radius(radius_cells);
  fill(radius_cells,
       [&](const Eigen::Vector3i& o) { return (o.cast<double>() - center).squaredNorm() < r2; });
}

Ball Ball::with_moves(double radius_cells) {
  Ball out(radius_cells);
  out.rows_.clear();
  out.fill(radius_cells,
           [&](const Eigen::Vector3i& o) { return near_moves(o, squared_radius(radius_cells)); });
  return out;
}

ClearanceRule::ClearanceRule(double clearance_cells) : moves_(Ball::with_moves(checked(clearance_cells))) {}

ClearanceRule::ClearanceRule(double clearance_cells, double search_cells)
    : moves_(Ball::with_moves(checked(search_cells))) {
  for (int shift = 0; shift < 8; ++shift) points_.emplace_back(checked(clearance_cells), shift);
}

int ClearanceRule::extent() const {
  int extent = moves_.extent();
  for (const Ball& b : points_) extent = std::max(extent, b.extent() + 1);
  return extent;
}

TileBits FreeTiles::clear_cells(const TileKey& t, const ClearanceRule& rule) const {
  TileBits out = bits(t);
  if (std::all_of(out.begin(), out.end(), [](std::uint32_t r) { return r == 0; })) return out;
  const int p = rule.extent();
  WideRows free(p);
  const int most = (p + 7) / 8;  // tiles on each side that the margin reaches into
  for (int tz = -most; tz <= most; ++tz)
    for (int ty = -most; ty <= most; ++ty) {
      const TileBits &before = bits({t.x - 1, t.y + ty, t.z + tz}), &here = bits({t.x, t.y + ty, t.z + tz}),
                     &after = bits({t.x + 1, t.y + ty, t.z + tz});
      for (int z = std::max(8 * tz, -p); z < std::min(8 * tz + 8, 8 + p); ++z)
        for (int y = std::max(8 * ty, -p); y < std::min(8 * ty + 8, 8 + p); ++y) {
          const std::uint32_t r = row_of(y, z);
          free.at(y, z) =
              std::uint64_t{before[r]} >> 16 | std::uint64_t{here[r]} << 16 | std::uint64_t{after[r]} << 48;
        }
    }
  const std::vector<WideRows> eroded = eroded_along_x(std::move(free), p);

  const auto for_each_row = [](const auto& f) {
    for (int z = 0; z < 8; ++z)
      for (int y = 0; y < 8; ++y) f(y, z);
  };
  for_each_row([&](int y, int z) {
    std::uint32_t& result = out[row_of(y, z)];
    result = narrowed(fitting(eroded, rule.moves(), y, z, widened(result)));
  });
  if (rule.points().empty()) return out;

  TileBits with_point{};  // cells that contain a clear point
  for_each_row([&](int y, int z) {
    with_point[row_of(y, z)] = narrowed(fitting(eroded, rule.points()[0], y, z, widened(out[row_of(y, z)])));
  });
  // The point half a cell up from k is half a cell down from the next cell: in each axis it counts for both.
  // Only cells that still lack a point are tested.
  for (std::size_t shift = 1; shift < rule.points().size(); ++shift) {
    const Ball& ball = rule.points()[shift];
    for (int z = ball.shift() & 4 ? -1 : 0; z < 8; ++z)
      for (int y = ball.shift() & 2 ? -1 : 0; y < 8; ++y) {
        const auto for_each_above = [&](const auto& f) {
          for (int up_z = 0; up_z <= (ball.shift() >> 2 & 1); ++up_z)
            for (int up_y = 0; up_y <= (ball.shift() >> 1 & 1); ++up_y)
              if (y + up_y >= 0 && y + up_y < 8 && z + up_z >= 0 && z + up_z < 8)
                f(row_of(y + up_y, z + up_z));
        };
        std::uint64_t wanted = 0;
        for_each_above([&](std::size_t row) { wanted |= widened(out[row] & ~with_point[row]); });
        if (ball.shift() & 1) wanted |= wanted >> 1;
        std::uint64_t fits = fitting(eroded, ball, y, z, wanted);
        if (ball.shift() & 1) fits |= fits << 1;
        for_each_above([&](std::size_t row) { with_point[row] |= narrowed(fits); });
      }
  }
  for_each_row([&](int y, int z) { out[row_of(y, z)] &= with_point[row_of(y, z)]; });
  return out;
}

}  // namespace karst::core
