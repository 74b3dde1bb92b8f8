// A walk with a LiDAR through a room whose ranges are known in closed form.
#pragma once
#include <cmath>
#include <numbers>
#include <string>

#include "core_stack/common/geometry.h"
#include "core_stack/common/random.h"
#include "tests/unit/replay/folder.h"

namespace karst::test {

constexpr double kBegin_s = 1000, kPeriod_s = 0.1;
constexpr int kScans = 25, kRings = 16, kColumns = 360;

/// A walk through the room: up to 0.8 m/s, turning by 0.3 rad/s; at rest at first.
inline core::Pose pose_at(double t_s) {
  const double s = std::max(0.0, t_s), along = 0.8 * (s - std::tanh(s));
  return {core::Vec3(along, 0.3 * std::sin(0.8 * along), 0.1 * std::sin(along)),
          core::from_heading(0.3 * (s - std::tanh(s)))};
}

/// Range from inside a 14 x 9 x 5 m room with two square pillars.
inline double range_in_room(const core::Vec3& from, const core::Vec3& direction) {
  double nearest = 1e9;
  const auto slab = [&](const core::Vec3& low, const core::Vec3& high, bool inside) {
    double enter = -1e9, leave = 1e9;
    for (int a = 0; a < 3; ++a) {
      const double u = (low[a] - from[a]) / direction[a], v = (high[a] - from[a]) / direction[a];
      enter = std::max(enter, std::min(u, v)), leave = std::min(leave, std::max(u, v));
    }
    if (inside) nearest = std::min(nearest, leave);
    if (!inside && enter > 0 && enter < leave) nearest = std::min(nearest, enter);
  };
  slab({-6, -4, -1.5}, {8, 5, 3.5}, true);
  slab({3, 2, -1.5}, {4, 3, 3.5}, false);
  slab({-3, -3, -1.5}, {-2.2, -2.2, 3.5}, false);
  return nearest;
}

/// One turn of the sensor, clockwise from behind, written as records x y z t ring.
inline std::string scan_at(double end_s, core::Random& noise) {
  std::string bytes;
  for (int ring = 0; ring < kRings; ++ring)
    for (int j = 0; j < kColumns; ++j) {
      const double before_s = kPeriod_s * (1 - (j + 1.0) / kColumns);
      const core::Pose T = pose_at(end_s - before_s);
      const double azimuth = std::numbers::pi * (1 - 2 * (j + 0.5) / kColumns),
                   elevation = 0.35 - 0.7 * ring / (kRings - 1);
      const core::Vec3 d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                         std::sin(elevation));
      const core::Vec3 p = d * (range_in_room(T.position, T.orientation * d) + 0.01 * noise.normal());
      for (int a = 0; a < 3; ++a) put(bytes, static_cast<float>(p[a]));
      put(bytes, static_cast<float>(kPeriod_s - before_s));
      put(bytes, static_cast<float>(ring));
    }
  return bytes;
}

}  // namespace karst::test
