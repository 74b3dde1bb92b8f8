#include "plugins/simulator/environment/loose_rocks.h"

#include <cmath>

namespace karst::sim {

using core::Vec3;

namespace {

Vec3 position_of(const cave::LooseRock& b, double moving_s) {
  const double distance_m = (b.to - b.position).norm();
  if (distance_m == 0 || b.speed_mps == 0) return b.position;
  const double along_m = std::fmod(b.speed_mps * moving_s, 2 * distance_m);
  return b.position +
         (b.to - b.position) * ((along_m <= distance_m ? along_m : 2 * distance_m - along_m) / distance_m);
}

}  // namespace

bool LooseRocks::advance(double t_s, const Vec3& vehicle) {
  t_s_ = t_s;
  bool changed = false;
  for (std::size_t i = 0; i < rocks_.size(); ++i) {
    const cave::LooseRock& b = rocks_[i];
    const bool near = b.within_m == 0 || (vehicle - b.position).norm() < b.within_m;
    const bool comes = !there_since_s_[i] && t_s >= b.after_s && near;
    if (comes) there_since_s_[i] = t_s;
    changed = changed || comes || (there_since_s_[i] && b.speed_mps > 0);
  }
  return changed;
}

std::vector<cave::Sphere> LooseRocks::present() const {
  std::vector<cave::Sphere> spheres;
  for (std::size_t i = 0; i < rocks_.size(); ++i)
    if (there_since_s_[i])
      spheres.push_back({position_of(rocks_[i], t_s_ - *there_since_s_[i]), rocks_[i].radius_m});
  return spheres;
}

}  // namespace karst::sim
