#include "core_stack/homing/landing/link_estimate.h"

#include <algorithm>
#include <cmath>

namespace karst::core {

void describe(OptionTable& t, LinkEstimateOptions& o) {
  t.add("range", o.range_m, "m", 1, 5000, "reach of the radio in free air");
  t.add("path_loss_exponent", o.path_loss_exponent, "", 1, 6, "n of the log-distance law in air");
  t.add("rock_loss", o.rock_db_per_m, "", 0, 200, "dB a metre that the map does not show free; 0: none");
  t.add("spare", o.spare_db, "", 0, 40, "dB that a link must have to spare to be counted on");
}

double not_free_m(const VoxelMap& map, const Vec3& a, const Vec3& b) {
  // Sampled at a tenth of a cell, which is finer than radio losses are known.
  const double length_m = (b - a).norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(length_m / (0.1 * map.resolution_m()))));
  int outside = 0;
  for (int i = 0; i < steps; ++i) outside += map.at(Vec3(a + (b - a) * ((i + 0.5) / steps))) != Cell::free;
  return length_m * outside / steps;
}

double expected_margin_db(const VoxelMap& map, const Vec3& a, const Vec3& b, const LinkEstimateOptions& o) {
  const double d = std::max((b - a).norm(), 1.0);
  const double in_air_db = 10 * o.path_loss_exponent * std::log10(o.range_m / d) - o.spare_db;
  if (in_air_db < 0 || o.rock_db_per_m == 0) return in_air_db;
  return in_air_db - o.rock_db_per_m * not_free_m(map, a, b);
}

}  // namespace karst::core
