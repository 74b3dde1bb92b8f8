#include "core_stack/mission/decision/viewpoints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "core_stack/planning/search/grid_planner.h"

namespace karst::core {
namespace {

/// Candidate distances in metres, best first: near enough for a dense scan, far enough for an overview.
constexpr std::array kShells = {1.0, 1.8, 2.8, 4.0, 0.4};
constexpr std::array kElevations = {0.0, -0.35, 0.35, -0.8, 0.8, -1.4, 1.4};
constexpr int kAzimuths = 12;

/// A direction from a frontier to a candidate, and the heading that looks back.
struct Away {
  Vec3 direction;  // unit
  double heading_rad;
};

std::vector<Away> directions_around() {
  std::vector<Away> all;
  for (const double elevation : kElevations) {
    const int azimuths = std::abs(elevation) > 1.2 ? 4 : kAzimuths;
    for (int i = 0; i < azimuths; ++i) {
      const double azimuth = 2 * std::numbers::pi * i / azimuths;
      const Vec3 away(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                      std::sin(elevation));
      all.push_back({away, std::atan2(-away.y(), -away.x())});
    }
  }
  return all;
}

/// LiDAR rings spread with range: beyond this a scan is too sparse to close a frontier.
constexpr double kLidarViewRange_m = 10.0;

/// How many of at most eight sampled cells of the cluster have a free line of sight.
int cells_seen(const VoxelMap& map, const FrontierCluster& cluster, const VehicleDescription& vehicle,
               const Viewpoint& from) {
  const std::size_t stride = std::max<std::size_t>(1, cluster.cells.size() / 8);
  int seen = 0;
  for (std::size_t i = stride / 2; i < cluster.cells.size(); i += stride) {
    const Vec3 cell = map.center_of(cluster.cells[i]);
    if (in_view(vehicle, from, cell, kLidarViewRange_m) && !map.first_not_free(from.position, cell)) ++seen;
  }
  return seen;
}

/// `p` if it is clear, or the nearest clear point half a cell from it along some axes. In a narrow passage
/// the clear points form a thin line, which the shells of candidates mostly miss.
std::optional<Vec3> clear_near(const VoxelMap& map, const Vec3& p, double clearance_m) {
  const double step_m = map.resolution_m() / 2;
  // Clearance changes by at most the distance moved: no point that near could be clear.
  if (!is_clear(map, p, clearance_m - std::sqrt(3.0) * step_m - 1e-6)) return std::nullopt;
  std::optional<Vec3> best;
  int least = 4;
  for (int i = 0; i < 27; ++i) {
    const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1, d = x * x + y * y + z * z;
    if (d >= least) continue;
    if (const Vec3 q = p + step_m * Vec3(x, y, z); is_clear(map, q, clearance_m)) {
      best = q;
      least = d;
    }
  }
  return best;
}

/// The frontier cell nearest to the centroid represents the cluster: the centroid itself may lie in rock.
Vec3 cell_at_centroid(const VoxelMap& map, const FrontierCluster& cluster) {
  Vec3 target = cluster.centroid;
  double least = 1e9;
  for (const CellKey& k : cluster.cells) {
    const double d = (map.center_of(k) - cluster.centroid).squaredNorm();
    if (d < least) {
      least = d;
      target = map.center_of(k);
    }
  }
  return target;
}

double heading_towards(const Vec3& from, const Vec3& target) {
  return std::atan2(target.y() - from.y(), target.x() - from.x());
}

/// What leads from a cell to itself and its 26 neighbours.
constexpr auto kAround = [] {
  std::array<PackedCell, 27> steps{};
  for (int i = 0; i < 27; ++i)
    steps[static_cast<std::size_t>(i)] = pack({i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}) - pack({});
  return steps;
}();

/// Whether the centre of an occupied cell lies within `radius_m` of `p`.
bool rock_within(const VoxelMap& map, const Vec3& p, double radius_m) {
  const CellKey low = map.key_of(p - Vec3::Constant(radius_m)),
                high = map.key_of(p + Vec3::Constant(radius_m));
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x)
        if (map.at(CellKey{x, y, z}) == Cell::occupied &&
            (map.center_of(CellKey{x, y, z}) - p).squaredNorm() < radius_m * radius_m)
          return true;
  return false;
}

}  // namespace

bool in_view(const VehicleDescription& vehicle, const Viewpoint& from, const Vec3& target,
             double lidar_range_m) {
  const Pose T_world_body{from.position, from_heading(from.heading_rad)};
  const Vec3 target_body = T_world_body.inverse() * target;
  if (vehicle.lidar) {
    const Vec3 p = vehicle.lidar->T_body_lidar.inverse() * target_body;
    const double elevation = std::atan2(p.z(), std::hypot(p.x(), p.y()));
    if (p.norm() <= lidar_range_m && elevation <= vehicle.lidar->elevation_rad.front() &&
        elevation >= vehicle.lidar->elevation_rad.back())
      return true;
  }
  for (const auto& camera : vehicle.cameras) {
    const Vec3 p = camera->T_body_camera.inverse() * target_body;
    if (p.x() > 0 && p.norm() <= 0.9 * camera->max_range_m &&
        std::abs(p.y()) <= p.x() * std::tan(camera->horizontal_fov_rad / 2) &&
        std::abs(p.z()) <= p.x() * std::tan(camera->vertical_fov_rad / 2))
      return true;
  }
  return false;
}

int open_cells(const VoxelMap& map, const FrontierCluster& cluster) {
  VoxelReader reader(map);
  int open = 0;
  for (const CellKey& k : cluster.cells) {
    bool rock = false;
    for (int i = 0; i < 27 && !rock; ++i)
      rock = reader.at(pack(k) + kAround[static_cast<std::size_t>(i)]) == Cell::occupied;
    open += !rock;
  }
  return open;
}

std::optional<Viewpoint> find_viewpoint(const VoxelMap& map, const FrontierCluster& cluster,
                                        const VehicleDescription& vehicle, double clearance_m,
                                        const Roadmap* roadmap) {
  static const std::vector<Away> directions = directions_around();
  const Vec3 target = cell_at_centroid(map, cluster);
  VoxelReader reader(map);
  std::optional<Viewpoint> best;
  double best_value = 0;
  const auto consider = [&](const Vec3& position, double azimuth) {
    const Viewpoint v{position, azimuth};
    if (!in_view(vehicle, v, target, kLidarViewRange_m) || map.first_not_free(position, target)) return;
    // Facing the opening squarely counts as one more visible cell.
    const Vec3 away = position - target;
    const double value =
        cells_seen(map, cluster, vehicle, v) - away.normalized().dot(cluster.normal) - 0.2 * away.norm();
    if (!best || value > best_value) {
      best = v;
      best_value = value;
    }
  };
  for (const bool narrow : {false, true}) {
    for (const double radius : kShells) {
      for (const Away& away : directions) {
        const Vec3 position = target + radius * away.direction;
        if (reader.at(map.key_of(position)) != Cell::free) continue;
        if (!narrow) {
          if (is_clear(map, position, clearance_m)) consider(position, away.heading_rad);
        } else if (const auto clear = clear_near(map, position, clearance_m)) {
          consider(*clear, away.heading_rad);
        }
      }
      if (best) return best;
    }
  }
  if (roadmap == nullptr) return best;
  for (const Vec3& place : roadmap->places_near(target, kShells[3]))
    if (const auto clear = clear_near(map, place, clearance_m))
      consider(*clear, heading_towards(*clear, target));
  return best;
}

bool fits_through(const VoxelMap& map, const FrontierCluster& cluster, double radius_m) {
  return std::any_of(cluster.cells.begin(), cluster.cells.end(),
                     [&](const CellKey& k) { return !rock_within(map, map.center_of(k), radius_m); });
}

std::optional<Viewpoint> find_distant_viewpoint(const VoxelMap& map, const FrontierCluster& cluster,
                                                const VehicleDescription& vehicle,
                                                const ClearanceRoadmap& reachable) {
  const Vec3 target = cell_at_centroid(map, cluster);
  std::vector<Vec3> places = reachable.roadmap().places_near(target, kLidarViewRange_m);
  std::stable_sort(places.begin(), places.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - target).squaredNorm() < (b - target).squaredNorm();
  });
  for (const Vec3& place : places) {
    const Viewpoint v{place, heading_towards(place, target)};
    if (cells_seen(map, cluster, vehicle, v) == 0) continue;
    const auto clear = clear_near(map, place, reachable.clearance_m());
    if (clear && reachable.home_length_m(map, *clear)) return Viewpoint{*clear, v.heading_rad};
  }
  return std::nullopt;
}

}  // namespace karst::core
