#include "core_stack/team/right_of_way/separation.h"

#include <algorithm>
#include <tuple>

namespace karst::core {
namespace {

int urgency(const Neighbour& vehicle) {
  switch (vehicle.phase) {
    case TeamPhase::landing:
      return vehicle.heard ? 0 : 2;
    case TeamPhase::boxed:
      return 1;
    case TeamPhase::home:
      return 3;
    case TeamPhase::explore:
      return 4;
    default:
      return 5;
  }
}

constexpr double kComes_mps = 0.15;  // a slower vehicle is not approaching

double braking_room_m(const SeparationRule& rule, double speed_mps) {
  return rule.distance_m / 2 + speed_mps * rule.own_s + speed_mps * speed_mps / (2 * rule.brake_mps2);
}

}  // namespace

double closing_mps(const Neighbour& a, const Neighbour& b) {
  const Vec3 apart = b.position - a.position;
  if (apart.norm() < 1e-6) return 0;
  return (a.velocity_mps - b.velocity_mps).dot(apart.normalized());
}

double yield_distance_m(const SeparationRule& rule, const Neighbour& a, const Neighbour& b) {
  const double v = std::max(0.0, closing_mps(a, b));
  return rule.distance_m + v * rule.reaction_s + v * v / (2 * rule.brake_mps2);
}

double stop_distance_m(const SeparationRule& rule, const Neighbour& a, const Neighbour& b) {
  return braking_room_m(rule, std::max(0.0, closing_mps(a, b)));
}

bool stops_on_the_way(const SeparationRule& rule, const Neighbour& self, const Neighbour& other) {
  if (other.phase == TeamPhase::aside) return false;
  Neighbour standing = other;
  standing.velocity_mps.setZero();
  const double own_mps = closing_mps(self, standing);
  const double v = std::max(own_mps, closing_mps(self, other));
  return own_mps > kComes_mps && (other.position - self.position).norm() < braking_room_m(rule, v);
}

bool goes_before(const Neighbour& a, const Neighbour& b) {
  return std::tuple(urgency(a), a.robot) < std::tuple(urgency(b), b.robot);
}

std::vector<Neighbour> give_way_to(const SeparationRule& rule, const Neighbour& self,
                                   const std::vector<Neighbour>& others) {
  std::vector<Neighbour> out;
  for (const Neighbour& other : others) {
    if (other.phase == TeamPhase::aside) continue;
    const double distance_m = (other.position - self.position).norm();
    const bool both = closing_mps(self, other) > 0 && distance_m < stop_distance_m(rule, self, other);
    if (both || (goes_before(other, self) && distance_m < yield_distance_m(rule, self, other)))
      out.push_back(other);
  }
  return out;
}

}  // namespace karst::core
