#include "plugins/simulator/cave_generator/noise.h"

#include <cmath>

namespace karst::cave {
namespace {

std::uint32_t hash(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed) {
  std::uint32_t h = seed + static_cast<std::uint32_t>(x) * 0x8da6b343u +
                    static_cast<std::uint32_t>(y) * 0xd8163841u + static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  return h ^ (h >> 16);
}

/// Dot product with one of the twelve directions to a cube's edges.
double slope(std::uint32_t h, double x, double y, double z) {
  const std::uint32_t edge = h % 12;
  const double a = edge < 8 ? x : y, b = edge < 4 ? y : z;
  return (edge & 1u ? -a : a) + (edge & 2u ? -b : b);
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
double mix(double a, double b, double t) { return a + t * (b - a); }

}  // namespace

double gradient_noise(const core::Vec3& p, std::uint32_t seed) {
  const double fx = std::floor(p.x()), fy = std::floor(p.y()), fz = std::floor(p.z());
  const auto ix = static_cast<std::int32_t>(fx), iy = static_cast<std::int32_t>(fy),
             iz = static_cast<std::int32_t>(fz);
  const double x = p.x() - fx, y = p.y() - fy, z = p.z() - fz;
  const double u = fade(x), v = fade(y), w = fade(z);
  const auto corner = [&](int i, int j, int k) {
    return slope(hash(ix + i, iy + j, iz + k, seed), x - i, y - j, z - k);
  };
  const double low =
      mix(mix(corner(0, 0, 0), corner(1, 0, 0), u), mix(corner(0, 1, 0), corner(1, 1, 0), u), v);
  const double high =
      mix(mix(corner(0, 0, 1), corner(1, 0, 1), u), mix(corner(0, 1, 1), corner(1, 1, 1), u), v);
  return mix(low, high, w);
}

double gradient_noise(double s, std::uint32_t seed) {
  return 1.6 * gradient_noise(core::Vec3(s, 0.37, 0.71), seed);
}

}  // namespace karst::cave
