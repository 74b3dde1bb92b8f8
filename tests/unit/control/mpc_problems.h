// Random problems for the tracker's solver: feasible starts within the limits, targets smooth and rough.
#pragma once
#include <cmath>
#include <utility>
#include <vector>

#include "core_stack/common/random.h"
#include "core_stack/control/jerk_mpc.h"

namespace karst::core::test {

inline Vec3 random_vector(Random& r, double size) {
  return {r.uniform(-size, size), r.uniform(-size, size), r.uniform(-size, size)};
}

/// Of any direction, its length uniform up to `longest`.
inline Vec3 random_in_ball(Random& r, double longest) {
  const Vec3 v(r.normal(), r.normal(), r.normal());
  return v.normalized() * r.uniform(0, longest);
}

/// Levels the acceleration out evenly in as few steps as the jerk allows and then leaves it: a plan that
/// proves a start feasible where it keeps the limits.
inline bool can_level_out(const JerkMpcSetup& s, const Motion& start) {
  const int n =
      std::max(1, static_cast<int>(std::ceil(start.acceleration_mps2.norm() / (s.max_jerk_mps3 * s.step_s))));
  const Vec3 jerk = -start.acceleration_mps2 / (n * s.step_s);
  Motion m = start;
  for (int k = 0; k < n; ++k) {
    m = advanced(m, jerk, s.step_s);
    if (m.velocity_mps.norm() > s.max_speed_mps) return false;
  }
  return n <= s.steps;
}

inline Motion random_start(Random& r, const JerkMpcSetup& s) {
  for (;;) {
    const Motion m{random_vector(r, 1), random_in_ball(r, s.max_speed_mps),
                   random_in_ball(r, s.max_acceleration_mps2)};
    if (can_level_out(s, m)) return m;
  }
}

/// A third each: a straight line at constant speed; straight lines between random corners; jumps between
/// random points. Points farther than the vehicle could come are drawn in, as the tracker does.
inline std::vector<MotionTarget> random_targets(Random& r, const JerkMpcSetup& s, const Motion& start) {
  std::vector<Vec3> points;  // at the ends of the steps, the first at the start
  const int kind = static_cast<int>(r.uniform(0, 3));
  Vec3 at = start.position + random_vector(r, 0.5), velocity = random_in_ball(r, s.max_speed_mps);
  for (int k = 0; k <= s.steps; ++k) {
    points.push_back(at);
    if (kind > 0 && r.uniform(0, 1) < 0.1) {
      velocity = random_in_ball(r, 1.5 * s.max_speed_mps);
      if (kind == 2) at += random_vector(r, 2), velocity.setZero();
    }
    at += velocity * s.step_s;
  }
  std::vector<MotionTarget> out;
  for (int k = 1; k <= s.steps; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vec3 offset = points[i] - start.position;
    const double reachable_m = s.max_speed_mps * (k * s.step_s + 0.3);
    out.push_back({start.position + offset * std::min(1.0, reachable_m / std::max(offset.norm(), 1e-9)),
                   (points[i] - points[i - 1]) / s.step_s});
  }
  return out;
}

/// The most by which a plan exceeds a limit, in the limit's unit; negative within.
inline double violation(const JerkMpcSetup& s, const Motion& start, const std::vector<Vec3>& jerks) {
  double worst = -1e9;
  Motion m = start;
  for (const Vec3& j : jerks) {
    m = advanced(m, j, s.step_s);
    worst = std::max({worst, m.velocity_mps.norm() - s.max_speed_mps,
                      m.acceleration_mps2.norm() - s.max_acceleration_mps2, j.norm() - s.max_jerk_mps3});
  }
  return worst;
}

}  // namespace karst::core::test
