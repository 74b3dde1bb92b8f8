#include "core_stack/planning/trajectory/speed_by_trust.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace karst::core {
namespace {

/// The lower one of the two values beside the place.
double lower_at(const std::vector<double>& speeds_mps, double spacing_m, double to_end_m) {
  if (speeds_mps.empty()) return std::numeric_limits<double>::infinity();
  const double at = std::max(0.0, to_end_m) / spacing_m, last = static_cast<double>(speeds_mps.size() - 1);
  return std::min(speeds_mps[static_cast<std::size_t>(std::min(std::floor(at), last))],
                  speeds_mps[static_cast<std::size_t>(std::min(std::ceil(at), last))]);
}

}  // namespace

double stopping_speed_mps(double free_m, double reaction_s, double braking_mps2) {
  const double lost_mps = braking_mps2 * reaction_s;
  return std::sqrt(lost_mps * lost_mps + 2 * braking_mps2 * std::max(0.0, free_m)) - lost_mps;
}

double speed_beside_rock_mps(double gap_m) { return std::max(0.0, gap_m) / kGapTime_s; }

double TrustedSpeeds::sight_at_mps(double to_end_m) const { return lower_at(sight_mps, spacing_m, to_end_m); }
double TrustedSpeeds::room_at_mps(double to_end_m) const { return lower_at(room_mps, spacing_m, to_end_m); }

}  // namespace karst::core
