#include "plugins/simulator/radio/radio_link.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace karst::sim {
namespace {

using core::Vec3;

/// Distances at which the segment crosses surfaces of the mesh, nearest first; surfaces closer together than
/// a millimetre count once.
std::vector<double> surfaces_between(const cave::RayScene& scene, const Vec3& a, const Vec3& b) {
  constexpr double kStep_m = 1e-3;
  const double length_m = (b - a).norm();
  std::vector<double> out;
  if (length_m < kStep_m) return out;
  const Vec3 direction = (b - a) / length_m;
  std::uint32_t last = cave::kBoulder;
  for (double from_m = 0; from_m < length_m;) {
    const cave::Ray ray{(a + from_m * direction).cast<float>(), direction.cast<float>()};
    const cave::Hit hit = scene.cast(ray, static_cast<float>(length_m - from_m));
    if (!hit.any()) break;
    from_m += static_cast<double>(hit.range_m);
    // No line crosses a triangle twice: a second hit means grazing incidence, where a step hardly leaves it.
    if (hit.triangle != last) out.push_back(from_m);
    last = hit.triangle;
    from_m += kStep_m;
  }
  return out;
}

/// Length of the segment within a ball.
double chord_m(const cave::Sphere& ball, const Vec3& a, const Vec3& b) {
  if (a == b) return 0;
  const Vec3 d = (b - a).normalized(), to = a - ball.centre;
  const double half = to.dot(d), rest = half * half - (to.squaredNorm() - ball.radius_m * ball.radius_m);
  if (rest <= 0) return 0;
  const double first = -half - std::sqrt(rest), last = -half + std::sqrt(rest);
  return std::max(std::min(last, (b - a).norm()) - std::max(first, 0.0), 0.0);
}

}  // namespace

void describe(core::OptionTable& t, LinkOptions& o) {
  t.add("propagation", o.propagation,
        "rock: air and rock on the straight line weaken it; distance: all is heard within the range");
  t.add("range", o.range_m, "m", 1, 5000, "reach in free air");
  t.add("path_loss_exponent", o.path_loss_exponent, "", 1, 6, "n of the log-distance law in air");
  t.add("rock_loss", o.rock_db_per_m, "", 0, 200, "dB that a metre of rock takes");
  t.add("fading", o.fading_db, "", 0, 20, "dB, standard deviation of a packet's strength");
}

double rock_between_m(const cave::RayScene& scene, const Vec3& a, const Vec3& b) {
  double rock_m = 0;
  for (const cave::Sphere& s : scene.boulders()) rock_m += chord_m(s, a, b);
  const std::vector<double> at =
      surfaces_between(scene.boulders().empty() ? scene : scene.with_boulders({}), a, b);
  if (at.size() % 2 == 1) return rock_m + at.back() - at.front();
  for (std::size_t i = 0; i + 1 < at.size(); i += 2) rock_m += at[i + 1] - at[i];
  return rock_m;
}

double link_margin_db(const LinkOptions& o, const cave::RayScene& scene, const Vec3& a, const Vec3& b) {
  const double d = (b - a).norm();
  if (o.propagation == Propagation::distance)
    return d <= o.range_m ? std::numeric_limits<double>::infinity()
                          : -std::numeric_limits<double>::infinity();
  // The law does not hold below 1 m, where the signal is strong enough anyway.
  const double margin_db = 10 * o.path_loss_exponent * std::log10(o.range_m / std::max(d, 1.0));
  // Skips the search for rock where air alone attenuates too much, fading included.
  if (margin_db < -6 * o.fading_db) return margin_db;
  return margin_db - o.rock_db_per_m * rock_between_m(scene, a, b);
}

}  // namespace karst::sim
