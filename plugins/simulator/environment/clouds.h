// Dust and droplets as light meets them: what a beam loses on its way, and what they send back.
//
// Light is lost by Beer and Lambert, I = I0 exp(-tau), tau the optical depth: extinction integrated along the
// way. Of what is lost a share 1/S per steradian comes straight back, S the cloud's lidar ratio. A pulse of
// length c t / 2 gathers that over its length; rock, a Lambert surface of reflectivity rho, sends rho / pi.
// So a stretch of cloud between the optical depths a and b is as bright as rock of reflectivity
//
//   (pi / 2) (1 / S) (exp(-2 a) - exp(-2 b))
//
// in its place: never above 0.03 for dust and 0.08 for droplets, where dry rock has 0.2 to 0.6. Around that
// mean an echo is distributed exponentially: many scatterers at random distances (speckle; Goodman, Speckle
// Phenomena in Optics, 2007; in radar, Swerling's second case). Model after Hahner et al., Fog Simulation on
// Real LiDAR Point Clouds, ICCV 2021, whose soft target it is.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "core_stack/common/random.h"
#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/cave/ray_scene.h"

namespace karst::sim {

/// What hangs in the air at one moment, and the randomness of its echoes, apart from any sensor's own noise:
/// a measurement in clear air is the same bytes with and without clouds elsewhere.
struct Air {
  std::vector<cave::Cloud> clouds;
  core::Random random{0};
};

/// A beam's way through one cloud.
struct Passage {
  double enter_m = 0, leave_m = 0, extinction_1pm = 0, backscatter_1psr = 0;

  double length_within_m(double from_m, double to_m) const {
    return std::max(std::min(leave_m, to_m) - std::max(enter_m, from_m), 0.0);
  }
};

/// A beam's way through all clouds; empty for most beams. Reusing one saves its allocation.
class CloudyPath {
 public:
  /// `ray.direction` is a unit vector.
  void trace(std::span<const cave::Cloud> clouds, const cave::Ray& ray);
  bool clear() const { return passages_.empty(); }
  /// Optical depth from the sensor to `range_m`.
  double depth(double range_m) const;
  /// Share of light that comes back from `range_m`, there and back.
  double two_way(double range_m) const { return std::exp(-2 * depth(range_m)); }

  /// A stretch of the way, no longer than a pulse: its echo's mean, as a reflectivity, and where it lies.
  struct Stretch {
    double from_m = 0, to_m = 0;  // of its cloudy part
    double depth = 0;             // optical, of itself
    double mean_echo = 0;
    double echo(core::Random& random) const { return -mean_echo * std::log(1 - random.uniform()); }
    /// Where in it the echo came from: more often from its near end.
    double place_m(core::Random& random) const;
  };
  /// Calls f(Stretch) for each cloudy stretch between two ranges, the nearest first, until nothing more can
  /// come back.
  template <class F>
  void for_each_stretch(double near_m, double far_m, double length_m, F&& f) const {
    if (clear()) return;
    constexpr double kOpaque = 8;  // exp(-16): nothing comes back from there
    double before = depth(near_m);
    const double first_m = std::max(near_m, first_m_), last_m = std::min(far_m, last_m_);
    for (double a = first_m; a < last_m && before < kOpaque; a += length_m) {
      const Stretch s = stretch(a, std::min(a + length_m, last_m), before);
      before += s.depth;
      if (s.depth > 0) f(s);
    }
  }

 private:
  Stretch stretch(double from_m, double to_m, double depth_before) const;

  std::vector<Passage> passages_;
  double first_m_ = 0, last_m_ = 0;
};

}  // namespace karst::sim
