#include "core_stack/homing/landing/landing_ground.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core_stack/mapping/region/flight_region.h"
#include "core_stack/planning/free_space/free_tiles.h"

namespace karst::core {
namespace {

/// The first cell at or below `k` that is not free, at most `most` cells down.
std::optional<CellKey> first_below(const VoxelMap& map, CellKey k, int most) {
  for (int i = 0; i <= most; ++i, --k.z)
    if (map.at(k) != Cell::free) return k;
  return std::nullopt;
}

/// Whether the hull stays in the map's region while it comes down from `top` to `ground_z_m`.
bool descends_inside(const VoxelMap& map, const Vec3& top, double ground_z_m, double radius_m) {
  if (!map.region()) return true;
  const double step_m = map.resolution_m() / 2;
  for (double z = top.z(); z > ground_z_m + radius_m; z -= step_m)
    if (map.region()->depth_m({top.x(), top.y(), z}) < radius_m) return false;
  return map.region()->depth_m({top.x(), top.y(), std::min(top.z(), ground_z_m + radius_m)}) >= radius_m;
}

/// The slope of the fitted plane, and the range of heights above it.
void fit_plane(const std::vector<Vec3>& points, Ground& out) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix2d a = 1e-12 * Eigen::Matrix2d::Identity();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const Vec3& p : points) {
    const Vec3 d = p - mean;
    a += d.head<2>() * d.head<2>().transpose();
    b += d.z() * d.head<2>();
  }
  const Eigen::Vector2d gradient = a.ldlt().solve(b);
  double low = 0, high = 0;
  for (const Vec3& p : points) {
    const Vec3 d = p - mean;
    const double above = d.z() - gradient.dot(d.head<2>());
    low = std::min(low, above);
    high = std::max(high, above);
  }
  out.slope_rad = std::atan(gradient.norm());
  out.step_m = high - low;
}

/// The 26-connected components of the set cells of a cube.
class Pieces {
 public:
  Pieces(const std::vector<char>& set, int edge) : of_(set.size(), -1) {
    std::vector<int> open;
    for (std::size_t seed = 0; seed < set.size(); ++seed) {
      if (!set[seed] || of_[seed] >= 0) continue;
      of_[seed] = count_;
      open = {static_cast<int>(seed)};
      while (!open.empty()) {
        const int i = open.back(), x = i % edge, y = i / edge % edge, z = i / edge / edge;
        open.pop_back();
        for (int n = 0; n < 27; ++n) {
          const int u = x + n % 3 - 1, v = y + n / 3 % 3 - 1, w = z + n / 9 - 1;
          if (std::min({u, v, w}) < 0 || std::max({u, v, w}) >= edge) continue;
          const auto k = static_cast<std::size_t>((w * edge + v) * edge + u);
          if (set[k] && of_[k] < 0) {
            of_[k] = count_;
            open.push_back(static_cast<int>(k));
          }
        }
      }
      ++count_;
    }
  }
  int of(std::size_t i) const { return of_[i]; }
  int count() const { return count_; }

 private:
  std::vector<int> of_;
  int count_ = 0;
};

}  // namespace

Ground ground_below(const VoxelMap& map, const Vec3& place, double vehicle_radius_m,
                    const GroundOptions& options) {
  Ground out;
  const auto refused = [&out](GroundVerdict why) {
    out.verdict = why;
    return out;
  };
  const double res = map.resolution_m(), radius_m = vehicle_radius_m + options.margin_m;
  const CellKey top = map.key_of(place);
  const int most = static_cast<int>(std::ceil(options.max_drop_m / res));
  const auto floor = first_below(map, top, most);
  if (!floor || floor->z == top.z) return out;
  if (map.at(*floor) != Cell::occupied) return refused(GroundVerdict::unknown);
  out.ground = {place.x(), place.y(), map.center_of(*floor).z() + res / 2};
  if (!descends_inside(map, place, out.ground.z(), vehicle_radius_m))
    return refused(GroundVerdict::obstructed);
  // Ground may drop by the full step and slope; farther down it does not count.
  const double fall_m =
      options.max_step_m + 2 * radius_m * std::tan(options.max_slope_deg * std::numbers::pi / 180);
  const int lowest = top.z - floor->z + static_cast<int>(std::ceil(fall_m / res));
  const int radius = static_cast<int>(std::ceil(radius_m / res));
  std::vector<Vec3> ground;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) {
      const CellKey column = top + CellKey{dx, dy, 0};
      const Vec3 c = map.center_of(column);
      if ((c - place).head<2>().norm() > radius_m) continue;
      const auto k = first_below(map, column, lowest);
      if (!k) return refused(GroundVerdict::rough);
      if (map.at(*k) == Cell::unknown) return refused(GroundVerdict::unknown);
      if (k->z == top.z) return refused(GroundVerdict::obstructed);
      ground.push_back({c.x(), c.y(), map.center_of(*k).z() + res / 2});
    }
  fit_plane(ground, out);
  out.verdict = out.slope_rad > options.max_slope_deg * std::numbers::pi / 180 ? GroundVerdict::steep
                : out.step_m > options.max_step_m                              ? GroundVerdict::rough
                                                                               : GroundVerdict::good;
  return out;
}

bool keeps_passage_open(const VoxelMap& map, const Vec3& standing, double vehicle_radius_m,
                        double clearance_m, double radius_m) {
  const double res = map.resolution_m();
  FreeTiles free(res);
  const ClearanceRule rule(clearance_m / res);
  free.load_near(map, standing, radius_m + (rule.extent() + 1) * res);
  const int half = static_cast<int>(std::ceil(radius_m / res)), edge = 2 * half + 1;
  const CellKey low = map.key_of(standing) + CellKey{-half, -half, -half};
  std::vector<char> before(static_cast<std::size_t>(edge * edge * edge));
  const TileKey first = tile_of(low), last = tile_of(low + CellKey{edge - 1, edge - 1, edge - 1});
  for (std::int32_t tz = first.z; tz <= last.z; ++tz)
    for (std::int32_t ty = first.y; ty <= last.y; ++ty)
      for (std::int32_t tx = first.x; tx <= last.x; ++tx) {
        const TileBits bits = free.clear_cells({tx, ty, tz}, rule);
        const CellKey corner = corner_of({tx, ty, tz});
        for (std::uint32_t i = 0; i < kTileCells; ++i) {
          if (!(bits[i >> 5] >> (i & 31) & 1)) continue;
          const CellKey k = cell_in_tile(corner, i);
          const int x = k.x - low.x, y = k.y - low.y, z = k.z - low.z;
          if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= edge) continue;
          before[static_cast<std::size_t>((z * edge + y) * edge + x)] = 1;
        }
      }
  std::vector<char> after = before;
  const auto cell = [&](std::size_t i) {
    const int n = static_cast<int>(i);
    return CellKey{n % edge, n / edge % edge, n / edge / edge};
  };
  for (std::size_t i = 0; i < after.size(); ++i)
    if ((map.center_of(low + cell(i)) - standing).norm() < vehicle_radius_m + clearance_m) after[i] = 0;

  const Pieces old_pieces(before, edge), new_pieces(after, edge);
  std::vector<int> became(static_cast<std::size_t>(old_pieces.count()), -1);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const CellKey k = cell(i);
    const bool on_face = std::min({k.x, k.y, k.z}) == 0 || std::max({k.x, k.y, k.z}) == edge - 1;
    if (!on_face || !before[i]) continue;
    if (!after[i]) return false;  // the cube is too small to decide
    int& piece = became[static_cast<std::size_t>(old_pieces.of(i))];
    if (piece >= 0 && piece != new_pieces.of(i)) return false;
    piece = new_pieces.of(i);
  }
  return true;
}

}  // namespace karst::core
