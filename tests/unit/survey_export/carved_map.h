// Caves as maps in memory: cells whose centre is in the cave are free, those around it rock, or unknown where
// nobody looked.
#pragma once
#include <functional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "sdk/survey_export/flown_survey.h"

namespace karst::test {

constexpr double kCell_m = 0.2;

using Inside = std::function<bool(const core::Vec3&)>;

inline Inside box(const core::Vec3& low, const core::Vec3& high) {
  return [low, high](const core::Vec3& p) {
    return (p.array() > low.array()).all() && (p.array() < high.array()).all();
  };
}
inline Inside any_of(std::vector<Inside> parts) {
  return [parts](const core::Vec3& p) {
    for (const Inside& part : parts)
      if (part(p)) return true;
    return false;
  };
}
inline Inside nowhere() {
  return [](const core::Vec3&) { return false; };
}

/// All cells of the box from `low` to `high`.
inline core::VoxelMap carved(const Inside& cave, const core::Vec3& low, const core::Vec3& high,
                             const Inside& unknown = nowhere()) {
  core::MapOptions options;
  options.resolution_m = kCell_m;
  core::VoxelMap map(options);
  const core::CellKey first = map.key_of(low), last = map.key_of(high);
  for (std::int32_t z = first.z; z <= last.z; ++z)
    for (std::int32_t y = first.y; y <= last.y; ++y)
      for (std::int32_t x = first.x; x <= last.x; ++x) {
        const core::CellKey k{x, y, z};
        const core::Vec3 p = map.center_of(k);
        if (!unknown(p)) map.assign(k, 1, cave(p) ? -2.0f : 2.0f);
      }
  return map;
}

/// Places on the way past these corners, a tenth of a metre apart.
inline std::vector<core::Vec3> way(const std::vector<core::Vec3>& corners) {
  std::vector<core::Vec3> out{corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const core::Vec3 step = corners[i] - corners[i - 1];
    const int n = static_cast<int>(step.norm() / 0.1);
    for (int k = 1; k <= n; ++k) out.emplace_back(corners[i - 1] + step * k / n);
  }
  return out;
}

inline survey_export::FlownSurvey surveyed(const core::VoxelMap& map, std::vector<core::Vec3> flown,
                                           std::vector<core::Vec3> frontiers = {}) {
  survey_export::FlownInput input;
  input.map = &map;
  input.flown = std::move(flown);
  input.frontiers = std::move(frontiers);
  input.accuracy.cell_m = map.resolution_m();
  input.name = "cave";
  input.title = "A test";
  input.source = "run";
  return survey_export::flown_survey(input);
}

/// 4 m wide and 3 m high, along x from 0 to 30 m; its axis is y = 0, z = 1.5.
inline Inside tunnel() { return box({0, -2, 0}, {30, 2, 3}); }
inline core::VoxelMap tunnel_map(const Inside& unknown = nowhere()) {
  return carved(tunnel(), {-1, -3, -1}, {31, 3, 4}, unknown);
}
inline std::vector<core::Vec3> tunnel_flight() { return way({{1, 0, 1.5}, {28, 0, 1.5}}); }

/// The tunnel, and a branch 3 m wide from its middle to y = 15.
inline core::VoxelMap tee_map() {
  return carved(any_of({tunnel(), box({13.4, 1, 0}, {16.4, 15, 3})}), {-1, -3, -1}, {31, 16, 4});
}

}  // namespace karst::test
