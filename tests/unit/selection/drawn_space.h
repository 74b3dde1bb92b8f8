// Free space by formula: a function that gives the distance to rock, negative inside it.
#pragma once
#include <cmath>
#include <functional>
#include <vector>

#include "sdk/selection/free_space.h"

namespace karst::test {

using core::CellKey;
using core::Vec3;
using Field = std::function<double(const Vec3&)>;

/// A round tube about a polyline, with ends like half balls.
inline Field tube(std::vector<Vec3> axis, double radius) {
  return [axis = std::move(axis), radius](const Vec3& p) {
    double nearest = 1e9;
    for (std::size_t i = 1; i < axis.size(); ++i) {
      const Vec3 d = axis[i] - axis[i - 1];
      const double s = std::clamp((p - axis[i - 1]).dot(d) / d.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (p - axis[i - 1] - s * d).norm());
    }
    return radius - nearest;
  };
}
/// Both together (the distance is exact where one of them holds the nearest rock).
inline Field either(Field a, Field b) {
  return [a = std::move(a), b = std::move(b)](const Vec3& p) { return std::max(a(p), b(p)); };
}
inline Field without_ball(Field a, Vec3 centre, double radius) {
  return [=](const Vec3& p) { return std::min(a(p), (p - centre).norm() - radius); };
}
inline std::vector<Vec3> circle(double radius, int corners, const Vec3& u, const Vec3& v) {
  std::vector<Vec3> axis;
  for (int i = 0; i <= corners; ++i) {
    const double a = 2 * M_PI * i / corners;
    axis.push_back(radius * (std::cos(a) * u + std::sin(a) * v));
  }
  return axis;
}

inline selection::FreeSpace space_of(const Field& field, const Vec3& low, const Vec3& high,
                                     double edge = 0.4) {
  selection::FreeSpace s;
  s.resolution_m = edge;
  const auto key = [edge](const Vec3& p) {
    const auto k = [edge](double v) { return static_cast<std::int32_t>(std::floor(v / edge)); };
    return CellKey{k(p.x()), k(p.y()), k(p.z())};
  };
  const CellKey a = key(low), b = key(high);
  s.flyable = evaluation::CellSet(a, b);
  std::size_t inside = 0;
  for (CellKey k{0, 0, a.z}; k.z <= b.z; ++k.z)
    for (k.y = a.y; k.y <= b.y; ++k.y)
      for (k.x = a.x; k.x <= b.x; ++k.x) {
        const double d = field(edge * Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5));
        inside += d > 0;
        if (d >= s.clearance_m) s.flyable.insert(k);
      }
  s.volume_m3 = static_cast<double>(inside) * std::pow(edge, 3);
  s.distance_to_rock = field;
  s.range_to_rock = [field](const Vec3& from, const Vec3& d) {
    double axis = 0;
    while (field(from + axis * d) > 1e-3 && axis < 500) axis += std::max(1e-3, field(from + axis * d));
    return axis;
  };
  return s;
}

}  // namespace karst::test
