#include "sdk/survey_export/wall_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::survey_export {
namespace {

using core::Cell;
using core::CellKey;
using core::Vec3;

/// Half way between where the ray enters the cell and where it leaves it.
double middle_m(const Vec3& from, const Vec3& d, const CellKey& k, double resolution_m) {
  const std::array<std::int32_t, 3> cell{k.x, k.y, k.z};
  double entry = 0, exit = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(d[axis]) < 1e-12) continue;
    const double low = (cell[static_cast<std::size_t>(axis)] * resolution_m - from[axis]) / d[axis];
    const double high = ((cell[static_cast<std::size_t>(axis)] + 1) * resolution_m - from[axis]) / d[axis];
    entry = std::max(entry, std::min(low, high));
    exit = std::min(exit, std::max(low, high));
  }
  return 0.5 * (entry + std::max(entry, exit));
}

}  // namespace

std::optional<double> wall_distance_m(const core::VoxelMap& map, const Vec3& from, const Vec3& d) {
  core::VoxelReader reader(map);
  bool in_gap = false;
  std::optional<CellKey> wall;
  core::traverse(from, from + kMostWall_m * d, map.resolution_m(), [&](const CellKey& k) {
    const Cell c = reader.at(k);
    if (c == Cell::occupied) {
      wall = k;
      return false;
    }
    if (c == Cell::unknown && in_gap) return false;
    in_gap = c == Cell::unknown;
    return true;
  });
  if (!wall) return std::nullopt;
  return middle_m(from, d, *wall, map.resolution_m());
}

bool runs_along_leg(const core::VoxelMap& map, const survey::Survey& survey, const Vec3& from, const Vec3& d,
                    double distance_m) {
  constexpr double kPart = 0.75;  // of the ray: before the rock at its end
  const double reached_m = kPart * distance_m, within_m = 0.5 * reached_m;
  const double least_along = std::sqrt(0.5);  // cosine of 45 degrees
  const Vec3 place = from + reached_m * d;
  for (const survey::Leg& leg : survey.legs) {
    const Vec3& a = survey.stations[leg.from].position_m;
    const Vec3 v = survey.stations[leg.to].position_m - a;
    const double length_m = v.norm();
    if (length_m < 1e-6 || std::abs(v.dot(d)) <= least_along * length_m) continue;
    const double part = std::clamp((place - a).dot(v) / (length_m * length_m), 0.0, 1.0);
    const Vec3 nearest = a + part * v;
    if ((place - nearest).norm() < within_m && !map.first_not_free(place, nearest)) return true;
  }
  return false;
}

survey::Dimensions across_passage(const core::VoxelMap& map, const survey::Survey& survey,
                                  const Vec3& station, const Vec3& facing, survey::Dimensions dimensions) {
  const Vec3 left(-facing.y(), facing.x(), 0);
  const auto keep = [&](std::optional<double>& distance_m, const Vec3& d) {
    if (distance_m && runs_along_leg(map, survey, station, d, *distance_m)) distance_m.reset();
  };
  keep(dimensions.left_m, left);
  keep(dimensions.right_m, -left);
  keep(dimensions.up_m, Vec3::UnitZ());
  keep(dimensions.down_m, -Vec3::UnitZ());
  return dimensions;
}

survey::Dimensions dimensions_at(const core::VoxelMap& map, const Vec3& station, const Vec3& facing) {
  const Vec3 left(-facing.y(), facing.x(), 0);
  return {wall_distance_m(map, station, left), wall_distance_m(map, station, -left),
          wall_distance_m(map, station, Vec3::UnitZ()), wall_distance_m(map, station, -Vec3::UnitZ())};
}

}  // namespace karst::survey_export
