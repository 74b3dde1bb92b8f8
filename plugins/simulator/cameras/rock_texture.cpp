#include "plugins/simulator/cameras/rock_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace karst::sim {

using core::Vec3;
using core::Vec3f;

namespace {

/// A number in [-1, 1] for each corner of a lattice.
float corner(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t octave) {
  std::uint32_t h = x * 0x8da6b343u ^ y * 0xd8163841u ^ z * 0xcb1ab31fu ^ octave * 0x9e3779b9u;
  h = (h ^ h >> 16) * 0x7feb352du;
  h = (h ^ h >> 15) * 0x846ca68bu;
  h ^= h >> 16;
  return static_cast<float>(h) * (2.0f / 4294967295.0f) - 1.0f;
}

struct Noise {
  float value = 0;
  Vec3f gradient = Vec3f::Zero();  // per lattice cell
};

/// Values at the corners, blended with 6 t^5 - 15 t^4 + 10 t^3 (Perlin, Improving noise, 2002), whose slope
/// is smooth.
Noise noise(const Vec3& p, std::uint32_t octave) {
  std::array<std::uint32_t, 3> cell;
  Vec3f blend, rise;
  for (int a = 0; a < 3; ++a) {
    const double floor = std::floor(p[a]);
    cell[static_cast<std::size_t>(a)] = static_cast<std::uint32_t>(static_cast<std::int64_t>(floor));
    const auto t = static_cast<float>(p[a] - floor);
    blend[a] = t * t * t * (t * (6 * t - 15) + 10);
    rise[a] = 30 * t * t * (t * (t - 2) + 1);
  }
  std::array<float, 8> v;
  for (std::uint32_t i = 0; i < 8; ++i)
    v[i] = corner(cell[0] + (i & 1), cell[1] + (i >> 1 & 1), cell[2] + (i >> 2), octave);
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  // Along x, then y, then z, with the derivatives carried along.
  std::array<float, 4> x, dx;
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = mix(v[2 * i], v[2 * i + 1], blend.x());
    dx[i] = v[2 * i + 1] - v[2 * i];
  }
  const float y0 = mix(x[0], x[1], blend.y()), y1 = mix(x[2], x[3], blend.y());
  Noise n;
  n.value = mix(y0, y1, blend.z());
  n.gradient.x() = rise.x() * mix(mix(dx[0], dx[1], blend.y()), mix(dx[2], dx[3], blend.y()), blend.z());
  n.gradient.y() = rise.y() * mix(x[1] - x[0], x[3] - x[2], blend.z());
  n.gradient.z() = rise.z() * (y1 - y0);
  return n;
}

constexpr float kCoarsest_m = 1.6f;
constexpr std::uint32_t kOctaves = 8;  // down to 12 mm
constexpr float kBump = 0.05f;         // height of a bump over its width, before octaves are added up

}  // namespace

RockLook rock_look(const Vec3& place, float finest_m) {
  RockLook look;
  float shade = 0, coarse = 0, wave_m = kCoarsest_m;
  for (std::uint32_t i = 0; i < kOctaves; ++i, wave_m *= 0.5f) {
    // An octave fades out between four and two pixels per wavelength.
    const float fraction = std::clamp(wave_m / (2 * finest_m) - 1, 0.0f, 1.0f);
    if (fraction == 0) break;
    const Noise n = noise(place / static_cast<double>(wave_m), i);
    shade += 0.22f * fraction * n.value;
    if (i < 2) coarse += 0.5f * n.value;
    look.slope += kBump * fraction * n.gradient;
  }
  // Rock beds of a hand's breadth to half a metre, level except for the coarse noise.
  const auto bed = static_cast<float>(std::sin(14 * place.z() + 2.5 * static_cast<double>(coarse)));
  const float light = std::clamp(1 + shade + 0.12f * bed, 0.15f, 1.9f);
  look.tint = light * Vec3f(1.08f + 0.06f * coarse, 1.0f, 0.88f - 0.08f * coarse);  // ochre
  return look;
}

}  // namespace karst::sim
