// A passage whose rock is known in closed form: along a circle or a line, of a radius that varies.
#pragma once
#include <cmath>
#include <numbers>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/random.h"

namespace karst::test {

class RoughPassage {
 public:
  /// `ring`: the passage is a circle of this length; else a straight one, along x. `roughness_m` 0: a smooth
  /// tube.
  RoughPassage(double length_m, bool ring, double roughness_m, std::uint64_t seed)
      : length_m_(length_m), ring_(ring) {
    core::Random r(seed);
    for (int i = 0; i < 14; ++i) {
      const double wavelength_m = r.uniform(2, 9);
      // Whole waves along the ring.
      waves_.push_back({roughness_m * r.uniform(0.3, 1), std::floor(r.uniform(0, 4)),
                        2 * std::numbers::pi * std::round(length_m / wavelength_m) / length_m,
                        r.uniform(0, 6.28)});
    }
  }

  /// The middle of the passage at `s` metres, looking along it.
  core::Pose at(double s) const {
    if (!ring_) return {core::Vec3(s, 0, 0), core::Quat::Identity()};
    const double radius = length_m_ / (2 * std::numbers::pi), a = s / radius;
    return {core::Vec3(radius * std::sin(a), radius * (1 - std::cos(a)), 0), core::from_heading(a)};
  }
  /// Points of the rock from `range_m` before to `range_m` behind `s`, with noise, at random places.
  std::vector<core::Vec3f> rock(double s, double range_m, core::Random& r, std::size_t count = 2500) const {
    std::vector<core::Vec3f> points;
    for (std::size_t i = 0; i < count; ++i) {
      const double along = s + r.uniform(-range_m, range_m), turn = r.uniform(0, 2 * std::numbers::pi);
      const double radius = radius_at(along, turn) + 0.01 * r.normal();
      points.push_back(
          (at(along) * core::Vec3(0, radius * std::cos(turn), radius * std::sin(turn))).cast<float>());
    }
    return points;
  }

 private:
  double radius_at(double s, double turn) const {
    double radius = 2.2;
    for (const Wave& w : waves_) radius += w.amplitude_m * std::sin(w.around * turn + w.per_m * s + w.phase);
    return std::max(1.0, radius);
  }
  struct Wave {
    double amplitude_m, around, per_m, phase;
  };
  double length_m_;
  bool ring_;
  std::vector<Wave> waves_;
};

}  // namespace karst::test
