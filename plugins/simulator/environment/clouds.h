// Optics of dust and droplets: the attenuation of a beam along its path, and the light scattered back.
//
// Light is attenuated by I = I0 exp(-tau) (Beer-Lambert), tau the optical depth: extinction integrated along
// the path. A fraction 1/S per steradian of the lost light returns straight back, S the cloud's lidar ratio.
// A pulse of length c t / 2 integrates that over its length; rock, a Lambert surface of reflectivity rho,
// returns rho / pi. So cloud between the optical depths a and b is as bright as rock of reflectivity
//
//   (pi / 2) (1 / S) (exp(-2 a) - exp(-2 b))
//
// in its place: never above 0.03 for dust and 0.08 for droplets, while dry rock has 0.2 to 0.6. An echo is
// distributed exponentially with that mean: many scatterers at random distances (speckle; Goodman, Speckle
// Phenomena in Optics, 2007; in radar, Swerling's second case). The model is the soft target of Hahner et
// al., Fog Simulation on Real LiDAR Point Clouds, ICCV 2021.
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

/// The clouds at one moment, and a random stream for their echoes, separate from any sensor's own noise: a
/// measurement in clear air is the same bytes with and without clouds elsewhere.
struct Air {
  std::vector<cave::Cloud> clouds;
  core::Random random{0};
};

/// A beam's segment within one cloud.
struct Passage {
  double enter_m = 0, leave_m = 0, extinction_1pm = 0, backscatter_1psr = 0;

  double length_within_m(double from_m, double to_m) const {
    return std::max(std::min(leave_m, to_m) - std::max(enter_m, from_m), 0.0);
  }
};

/// A beam's segments within all clouds; empty for most beams. Reusing an object saves its allocation.
class CloudyPath {
 public:
  /// `ray.direction` is a unit vector.
  void trace(std::span<const cave::Cloud> clouds, const cave::Ray& ray);
  bool clear() const { return passages_.empty(); }
  /// Optical depth from the sensor to `range_m`.
  double depth(double range_m) const;
  /// Two-way transmittance to `range_m`, 0..1.
  double two_way(double range_m) const { return std::exp(-2 * depth(range_m)); }

  /// A piece of the path, no longer than a pulse: the mean of its echo, as a reflectivity, and its location.
  struct Stretch {
    double from_m = 0, to_m = 0;  // of its cloudy part
    double depth = 0;             // its own optical depth
    double mean_echo = 0;
    double echo(core::Random& random) const { return -mean_echo * std::log(1 - random.uniform()); }
    /// Draws the range from which the echo came: more often from the near end.
    double place_m(core::Random& random) const;
  };
  /// Calls f(Stretch) for each cloudy stretch between two ranges, the nearest first, until no more light can
  /// return.
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
