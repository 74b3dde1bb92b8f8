#include "core_stack/planning/horizon/view_gain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core_stack/mapping/region/flight_region.h"

namespace karst::core {
namespace {

constexpr double kSpacing_rad = 0.105;
constexpr double kMostCells = 64;      // from the middle to a side
constexpr double kManyCells = 30;      // for a ray
constexpr double kLidarRange_m = 8.0;  // farther away a scan is too sparse to close a frontier
constexpr double kLidarSpacing_rad = 0.26;

/// Directions on a grid of azimuth and elevation in the sensor's frame, at the cells' centres.
void add_rays(double azimuth_rad, double low_rad, double high_rad, double spacing_rad, double range_m,
              const Pose& T_body_sensor, std::vector<ViewRay>& out) {
  const int columns = std::max(1, static_cast<int>(std::lround(azimuth_rad / spacing_rad)));
  const int rows = std::max(1, static_cast<int>(std::lround((high_rad - low_rad) / spacing_rad)));
  const double da = azimuth_rad / columns, de = (high_rad - low_rad) / rows;
  for (int r = 0; r < rows; ++r) {
    const double e = low_rad + (r + 0.5) * de;
    for (int c = 0; c < columns; ++c) {
      const double a = -azimuth_rad / 2 + (c + 0.5) * da;
      const Vec3 direction(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
      out.push_back({T_body_sensor.orientation * direction, range_m, da * de * std::cos(e)});
    }
  }
}

}  // namespace

std::vector<ViewRay> view_rays(const VehicleDescription& vehicle) {
  std::vector<ViewRay> rays;
  for (const auto& c : vehicle.cameras)
    add_rays(c->horizontal_fov_rad, -c->vertical_fov_rad / 2, c->vertical_fov_rad / 2, kSpacing_rad,
             0.9 * c->max_range_m, c->T_body_camera, rays);
  if (const auto& l = vehicle.lidar)
    add_rays(2 * std::numbers::pi, l->elevation_rad.back(), l->elevation_rad.front(), kLidarSpacing_rad,
             std::min<double>(kLidarRange_m, l->max_range_m), l->T_body_lidar, rays);
  return rays;
}

ViewMap::ViewMap(const VoxelMap& map, const Vec3& center, double reach_m, std::span<const ViewRay> rays)
    : rays_(rays) {
  double longest_m = 0;
  for (const ViewRay& r : rays) longest_m = std::max(longest_m, r.range_m);
  const int shift = longest_m > kManyCells * map.resolution_m() ? 1 : 0;  // halves cells' coordinates
  resolution_m_ = map.resolution_m() * (1 << shift);
  const auto half =
      static_cast<std::int32_t>(std::min(kMostCells, std::ceil((reach_m + longest_m) / resolution_m_)));
  const CellKey k = map.key_of(center);
  low_ = {(k.x >> shift) - half, (k.y >> shift) - half, (k.z >> shift) - half};
  edge_ = 2 * half + 1;
  const auto e = static_cast<std::size_t>(edge_);
  cells_.assign(e * e * e, Cell::unknown);
  seen_by_.assign(cells_.size(), 0);
  std::vector<std::uint8_t> known(cells_.size(), 0);
  const int enough = shift == 0 ? 1 : 4;
  const CellKey beyond = low_ + CellKey{edge_, edge_, edge_};
  map.for_each_in_box({low_.x << shift, low_.y << shift, low_.z << shift},
                      {(beyond.x << shift) - 1, (beyond.y << shift) - 1, (beyond.z << shift) - 1},
                      [&](const CellKey& fine, Cell c) {
                        const std::size_t at = index_of({fine.x >> shift, fine.y >> shift, fine.z >> shift});
                        if (c == Cell::occupied) cells_[at] = Cell::occupied;
                        if (c == Cell::free && ++known[at] >= enough && cells_[at] == Cell::unknown)
                          cells_[at] = Cell::free;
                      });
  if (map.region()) leave_out_beyond(*map.region());
}

/// Nothing is gained by seeing unknown cells outside the region: they count as free.
void ViewMap::leave_out_beyond(const FlightRegion& region) {
  constexpr std::int32_t kBlock = 8;
  const auto center_of = [this](std::int32_t x, std::int32_t y, std::int32_t z, double half) {
    return Vec3(Vec3(low_.x + x + half, low_.y + y + half, low_.z + z + half) * resolution_m_);
  };
  const double radius_m = std::sqrt(3.0) / 2 * kBlock * resolution_m_;
  for (std::int32_t z = 0; z < edge_; z += kBlock)
    for (std::int32_t y = 0; y < edge_; y += kBlock)
      for (std::int32_t x = 0; x < edge_; x += kBlock) {
        // The depth changes by no more than the distance.
        if (region.depth_m(center_of(x, y, z, 0.5 * kBlock)) >= radius_m) continue;
        for (std::int32_t w = z; w < std::min(z + kBlock, edge_); ++w)
          for (std::int32_t v = y; v < std::min(y + kBlock, edge_); ++v)
            for (std::int32_t u = x; u < std::min(x + kBlock, edge_); ++u) {
              Cell& cell = cells_[index_of(low_ + CellKey{u, v, w})];
              if (cell == Cell::unknown && !region.contains(center_of(u, v, w, 0.5))) cell = Cell::free;
            }
      }
}

std::size_t ViewMap::index_of(const CellKey& k) const {
  const auto e = static_cast<std::size_t>(edge_);
  return (static_cast<std::size_t>(k.z - low_.z) * e + static_cast<std::size_t>(k.y - low_.y)) * e +
         static_cast<std::size_t>(k.x - low_.x);
}

bool ViewMap::holds(const CellKey& k) const {
  const CellKey at{k.x - low_.x, k.y - low_.y, k.z - low_.z};
  return at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < edge_ && at.y < edge_ && at.z < edge_;
}

double ViewMap::gain_m3(std::span<const ViewPose> poses) {
  const std::uint32_t before_first = last_pose_;
  double gain_m3 = 0;
  for (const ViewPose& pose : poses) {
    ++last_pose_;
    for (const Sight& sight : view_from(pose)) {
      std::uint32_t& seen_by = seen_by_[sight.cell];
      if (seen_by > before_first && seen_by != last_pose_) continue;
      seen_by = last_pose_;
      gain_m3 += sight.volume_m3;
    }
  }
  return gain_m3;
}

const std::vector<ViewMap::Sight>& ViewMap::view_from(const ViewPose& pose) {
  static const std::vector<Sight> kNone;
  const auto cell_of = [this](double m) { return static_cast<std::int32_t>(std::floor(m / resolution_m_)); };
  const CellKey cell{cell_of(pose.position.x()), cell_of(pose.position.y()), cell_of(pose.position.z())};
  if (!holds(cell)) return kNone;
  constexpr int kHeadings = 60;  // 0.105 rad apart
  constexpr double kApart_rad = 2 * std::numbers::pi / kHeadings;
  const auto heading = (std::lround(pose.heading_rad / kApart_rad) % kHeadings + kHeadings) % kHeadings;
  const auto [at, is_new] =
      views_.try_emplace(index_of(cell) * kHeadings + static_cast<std::uint64_t>(heading));
  if (is_new) at->second = look(cell, static_cast<double>(heading) * kApart_rad);
  return at->second;
}

std::vector<ViewMap::Sight> ViewMap::look(const CellKey& cell, double heading_rad) const {
  const double step_m = resolution_m_;
  const double share_a_step = std::exp(-step_m / kExpected_m), half_a_step = std::sqrt(share_a_step);
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  const Vec3 from = Vec3(cell.x - low_.x, cell.y - low_.y, cell.z - low_.z) + Vec3::Constant(0.5);
  std::vector<Sight> out;
  for (const ViewRay& ray : rays_) {
    const Vec3& d = ray.direction;
    const Vec3 step(c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z());  // one cell's edge
    const int steps = static_cast<int>(ray.range_m / resolution_m_);
    double share = half_a_step;
    Vec3 p = from - 0.5 * step;
    for (int i = 1; i <= steps; ++i) {  // at the middle of each step
      p += step;
      const auto x = static_cast<std::int32_t>(std::floor(p.x())),
                 y = static_cast<std::int32_t>(std::floor(p.y())),
                 z = static_cast<std::int32_t>(std::floor(p.z()));
      if (x < 0 || y < 0 || z < 0 || x >= edge_ || y >= edge_ || z >= edge_) break;
      const std::size_t at = index_of(low_ + CellKey{x, y, z});
      if (cells_[at] == Cell::occupied) break;
      if (cells_[at] == Cell::free) continue;
      const double r = (i - 0.5) * step_m;
      out.push_back(
          {static_cast<std::uint32_t>(at), static_cast<float>(share * r * r * ray.solid_angle_sr * step_m)});
      share *= share_a_step;
    }
  }
  return out;
}

}  // namespace karst::core
