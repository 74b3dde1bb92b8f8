// A vehicle in a drawn cave that its world model has mapped, for the tests of the explorer's parts.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core_stack/mission/world_model/world_model.h"
#include "tests/unit/mission/drawn_map.h"

namespace karst::core {

/// Stands at (3, 3, 1); a LiDAR that sees `half_fov_rad` up and down.
inline VehicleDescription lidar_vehicle_at_start(float half_fov_rad = 0.5f) {
  auto lidar = std::make_shared<LidarModel>();
  lidar->columns = 8;
  lidar->elevation_rad = {half_fov_rad, -half_fov_rad};
  VehicleDescription vehicle;
  vehicle.lidar = lidar;
  vehicle.T_world_start.position = Vec3(3, 3, 1);
  return vehicle;
}

/// Rays that make an empty map equal to `map` in what is free and what is occupied.
inline std::vector<Ray> rays_of(const VoxelMap& map) {
  std::vector<Ray> rays;
  const Vec3f up(0, 0, static_cast<float>(map.resolution_m()));
  map.for_each_known([&](const CellKey& k, Cell cell, float) {
    const Vec3f c = map.center_of(k).cast<float>();
    rays.push_back(cell == Cell::occupied ? Ray{c, c, true} : Ray{c, c + up, false});
  });
  return rays;
}

/// A closed room of 8 x 6 x 4 m around the start, but for the face "x+".
inline VoxelMap room_open_to_x() {
  VoxelMap map{MapOptions{}};
  carve_box(map, Vec3(0, 0, 0), Vec3(8, 6, 4), {"x+"});
  return map;
}

/// Two rooms along x, 6 x 6 x 3 m (x from 0 and from 9), and a corridor of 3 x 0.8 x 1.4 m of free cells
/// between them: too narrow for the usual clearance.
inline VoxelMap rooms_with_a_narrow_corridor() {
  VoxelMap map{MapOptions{}};
  carve_box(map, Vec3(0, 0, 0), Vec3(6, 6, 3));
  carve_box(map, Vec3(9, 0, 0), Vec3(15, 6, 3));
  const CellKey a = map.key_of(Vec3(5.7, 2.5, 0.7)), b = map.key_of(Vec3(9.3, 3.1, 1.9));
  for (int x = a.x; x <= b.x; ++x)
    for (int y = a.y; y <= b.y; ++y)
      for (int z = a.z; z <= b.z; ++z) map.assign({x, y, z}, 1, -1.0f);
  return map;
}

inline CoreOptions narrow_passages_allowed() {
  CoreOptions options;
  options.planning.narrow_margin_m = 0.08;
  return options;
}

}  // namespace karst::core
