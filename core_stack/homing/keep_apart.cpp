#include "core_stack/homing/keep_apart.h"

#include <algorithm>

namespace karst::core {
namespace {

/// Speed at which the distance shrinks; 0 if it grows.
double closing_mps(const Vec3& position, const Vec3& velocity_mps, const Neighbour& other) {
  const Vec3 apart = other.position - position;
  if (apart.norm() < 1e-6) return 0;
  return std::max(0.0, (velocity_mps - other.velocity_mps).dot(apart.normalized()));
}

}  // namespace

double least_distance_m(const KeepApart& rule, const Vec3& position, const Vec3& velocity_mps,
                        const Neighbour& other) {
  const double v = closing_mps(position, velocity_mps, other);
  return rule.distance_m + v * rule.reaction_s + v * v / (2 * rule.brake_mps2);
}

std::vector<Neighbour> give_way_to(const KeepApart& rule, RobotId self, const Vec3& position,
                                   const Vec3& velocity_mps, const std::vector<Neighbour>& others) {
  std::vector<Neighbour> out;
  for (const Neighbour& other : others) {
    const double distance_m = (other.position - position).norm();
    if (distance_m >= least_distance_m(rule, position, velocity_mps, other)) continue;
    const bool very_near = distance_m < rule.distance_m / 2 && closing_mps(position, velocity_mps, other) > 0;
    if (other.committed || other.robot < self || very_near) out.push_back(other);
  }
  return out;
}

}  // namespace karst::core
