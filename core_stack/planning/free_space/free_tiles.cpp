#include "core_stack/planning/free_space/free_tiles.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core_stack/mapping/region/flight_region.h"
#include "core_stack/planning/free_space/segment_rows.h"

namespace karst::core {
namespace {

constexpr int kNearestRadius = 15;  // a window of 32 cells around the point
constexpr TileBits kUnknownTile{};

struct Offset {
  int dy, dz;
  double distance;
};

/// Clears the cells of the tile at `corner` that the vehicle must not fly in.
void confine(TileBits& tile, const FlightRegion& region, const CellKey& corner, double resolution_m) {
  const auto center_of = [&](const CellKey& k) {
    return Vec3((Vec3(k.x, k.y, k.z).array() + 0.5) * resolution_m);
  };
  // The depth changes by no more than the distance: mostly the tile's centre decides for all of its cells.
  const Vec3 last = center_of(corner + CellKey{kTileX - 1, kTileY - 1, kTileZ - 1}),
             first = center_of(corner);
  const double beyond_m = region.depth_m((first + last) / 2) - region.limits().margin_m;
  if (beyond_m >= (last - first).norm() / 2) return;
  for (std::uint32_t i = 0; i < kTileCells; ++i)
    if (tile[i >> 5] >> (i & 31) & 1 && !region.may_fly(center_of(cell_in_tile(corner, i))))
      tile[i >> 5] &= ~(1u << (i & 31));
}

/// Offsets of the rows around a cell, nearest first.
std::vector<Offset> rows_by_distance() {
  std::vector<Offset> out;
  for (int dz = -kNearestRadius; dz <= kNearestRadius; ++dz)
    for (int dy = -kNearestRadius; dy <= kNearestRadius; ++dy)
      if (const double d = std::hypot(dy, dz); d <= kNearestRadius) out.push_back({dy, dz, d});
  std::stable_sort(out.begin(), out.end(),
                   [](const Offset& a, const Offset& b) { return a.distance < b.distance; });
  return out;
}

}  // namespace

CellKey FreeTiles::key_of(const Vec3& p) const {
  const auto cell = [&](double v) {
    return static_cast<std::int32_t>(std::floor(std::clamp(v / resolution_m_, -1e6, 1e6)));
  };
  return {cell(p.x()), cell(p.y()), cell(p.z())};
}

Vec3 FreeTiles::center_of(const CellKey& k) const {
  return (Vec3(k.x, k.y, k.z).array() + 0.5) * resolution_m_;
}

void FreeTiles::load(const VoxelMap& map, const CellKey& low, const CellKey& high) {
  const TileKey a = tile_of(low), b = tile_of(high);
  for (std::int32_t z = a.z; z <= b.z; ++z)
    for (std::int32_t y = a.y; y <= b.y; ++y)
      for (std::int32_t x = a.x; x <= b.x; ++x) {
        const TileKey t{x, y, z};
        if (table_.find(t) != TileTable::none) continue;
        table_.add(t);
        tiles_.push_back(std::make_unique<TileBits>());
        TileBits& tile = *tiles_.back();
        tile.fill(0);
        const CellKey corner = corner_of(t);
        map.for_each_in_box(corner, corner + CellKey{kTileX - 1, kTileY - 1, kTileZ - 1},
                            [&tile](const CellKey& k, Cell c) {
                              if (c == Cell::free) tile[row_of(k.y, k.z)] |= 1u << (k.x & 31);
                            });
        if (map.region() && confined_) confine(tile, *map.region(), corner, resolution_m_);
      }
}

void FreeTiles::load_near(const VoxelMap& map, const Vec3& p, double radius_m) {
  const Vec3 radius = Vec3::Constant(radius_m + resolution_m_);
  load(map, key_of(p - radius), key_of(p + radius));
}

void FreeTiles::refresh(const VoxelMap& map, const CellKey& k) {
  const std::uint32_t i = table_.find(tile_of(k));
  if (i == TileTable::none) return load(map, k, k);
  std::uint32_t& r = (*tiles_[i])[row_of(k.y, k.z)];
  const std::uint32_t bit = 1u << (k.x & 31);
  r = (confined_ ? map.may_fly(k) : map.at(k) == Cell::free) ? r | bit : r & ~bit;
}

const TileBits& FreeTiles::bits(const TileKey& t) const {
  const std::uint32_t i = table_.find(t);
  return i == TileTable::none ? kUnknownTile : *tiles_[i];
}

bool FreeTiles::at(const CellKey& k) const { return bits(tile_of(k))[row_of(k.y, k.z)] >> (k.x & 31) & 1; }

std::uint32_t FreeTiles::row(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const TileKey t = tile_of({x, y, z});
  const std::uint32_t r = row_of(y, z), first = bits(t)[r];
  const int shift = x & 31;
  if (shift == 0) return first;
  return first >> shift | bits({t.x + 1, t.y, t.z})[r] << (32 - shift);
}

/// Cache of the last tiles: neighbouring rows mostly lie in the same tile.
struct FreeTiles::LastTile {
  TileKey key;
  const TileBits* tile = nullptr;
};

bool FreeTiles::row_free(std::int32_t x_low, std::int32_t x_high, std::int32_t y, std::int32_t z,
                         LastTile& last) const {
  while (x_low <= x_high) {
    const TileKey t = tile_of({x_low, y, z});
    if (last.tile == nullptr || !(last.key == t)) last = {t, &bits(t)};
    const int shift = x_low & 31, n = std::min(32 - shift, x_high - x_low + 1);
    const std::uint32_t mask = n == 32 ? ~0u : (1u << n) - 1;
    if (((*last.tile)[row_of(y, z)] >> shift & mask) != mask) return false;
    x_low += n;
  }
  return true;
}

bool FreeTiles::segment_clear(const Vec3& a, const Vec3& b, double clearance_m) const {
  if (!(a.cwiseAbs().maxCoeff() < 1e6 && b.cwiseAbs().maxCoeff() < 1e6) || a.hasNaN() || b.hasNaN())
    return false;
  const Vec3 half = Vec3::Constant(0.5), from = a / resolution_m_ - half, to = b / resolution_m_ - half;
  LastTile last;
  const auto free = [&](std::int32_t x_low, std::int32_t x_high, std::int32_t y, std::int32_t z) {
    return row_free(x_low, x_high, y, z, last);
  };
  if (!all_rows_near_segment(from, to, clearance_m / resolution_m_, free)) return false;
  // The centre of a point's own cell is never farther than half a cell's diagonal.
  if (clearance_m > 0.87 * resolution_m_) return true;
  bool passed_free = true;
  traverse(a, b, resolution_m_, [&](const CellKey& k) { return passed_free = at(k); });
  return passed_free;
}

NearestObstacle FreeTiles::nearest(const Vec3& p, double limit_m) const {
  static const std::vector<Offset> rows = rows_by_distance();
  const CellKey c = key_of(p);
  const Vec3 q = p / resolution_m_ - Vec3::Constant(0.5);
  double best = std::min(limit_m / resolution_m_, static_cast<double>(kNearestRadius)), best2 = best * best;
  NearestObstacle out{std::min(limit_m, kNearestRadius * resolution_m_), p};
  // The window's rows lie in at most five by five pairs of tiles along x, each looked up when first used.
  struct Pair {
    const TileBits *low = nullptr, *high = nullptr;
  };
  std::array<Pair, 25> pairs{};
  const TileKey first = tile_of({c.x - 16, c.y - kNearestRadius, c.z - kNearestRadius});
  const int shift = (c.x - 16) & 31;
  const auto window_row = [&](std::int32_t y, std::int32_t z) {
    const TileKey t{first.x, y >> 3, z >> 3};
    Pair& pair = pairs[static_cast<std::size_t>((t.z - first.z) * 5 + t.y - first.y)];
    if (pair.low == nullptr) pair = {&bits(t), shift == 0 ? &kUnknownTile : &bits({t.x + 1, t.y, t.z})};
    const std::uint32_t r = row_of(y, z), low = (*pair.low)[r];
    return shift == 0 ? low : low >> shift | (*pair.high)[r] << (32 - shift);
  };
  for (const Offset& o : rows) {
    if (o.distance - 0.71 >= best) break;
    const double ry = c.y + o.dy - q.y(), rz = c.z + o.dz - q.z(), row2 = ry * ry + rz * rz;
    if (row2 >= best2) continue;
    const std::uint32_t blocked = ~window_row(c.y + o.dy, c.z + o.dz);  // bit 16 is c.x
    const std::uint32_t right = blocked >> 16, left = blocked << 16;    // from c.x up; from c.x - 1 down
    const auto consider = [&](int dx) {
      const double rx = c.x + dx - q.x(), d2 = row2 + rx * rx;
      if (d2 >= best2) return;
      best2 = d2;
      best = std::sqrt(d2);
      out = {best * resolution_m_, center_of({c.x + dx, c.y + o.dy, c.z + o.dz})};
    };
    if (right != 0) consider(std::countr_zero(right));
    if (left != 0) consider(-1 - std::countl_zero(left));
  }
  return out;
}

}  // namespace karst::core
