// Winding, knobbly tunnels drawn straight into a map: rock one or two cells thick, free space inside.
#pragma once
#include <cmath>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::test {

struct Tunnel {
  double phase = 0;      // another phase, another tunnel
  double bend_m = 4;     // how far it swings to the sides
  double knobs_m = 0.5;  // how rough it is
  double radius_m = 2;

  core::Vec3 centre(double x) const {
    return {x, bend_m * std::sin(0.17 * x + phase) + 0.5 * bend_m * std::sin(0.41 * x + 3 * phase),
            0.3 * bend_m * std::sin(0.23 * x + 2 * phase)};
  }
  /// Negative inside.
  double depth(const core::Vec3& p) const {
    const core::Vec3 d = p - centre(p.x());
    const double around = std::atan2(d.z(), d.y());
    const double knobs = std::sin(0.9 * p.x() + 2 * around + phase) +
                         std::sin(0.37 * p.x() - 3 * around + 5 * phase) +
                         0.7 * std::sin(1.7 * p.x() + around + 2 * phase);
    return std::hypot(d.y(), d.z()) - radius_m - knobs_m * knobs;
  }
  /// The stretch from `begin` to `end` along x, cells of 0.2 m.
  core::VoxelMap map(double begin, double end) const {
    core::VoxelMap map{core::MapOptions{}};
    for (double x = begin; x < end; x += 0.2)
      for (double y = -3 * bend_m - 6; y < 3 * bend_m + 6; y += 0.2)
        for (double z = -bend_m - 6; z < bend_m + 6; z += 0.2) {
          const core::Vec3 p = map.center_of(map.key_of({x, y, z}));
          const double d = depth(p);
          if (d < 0.15) map.assign(map.key_of(p), 1, d < -0.1 ? -1.5f : 2.0f);
        }
    return map;
  }
};

}  // namespace karst::test
