// A flight in closed form, and what an IMU measures on it.
#pragma once
#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"

namespace karst::core {

inline constexpr TimeNs kImuPeriod = 5 * kMillisecond;
inline const Vec3 kAccelBias(0.1, -0.08, 0.12), kGyroBias(0.01, -0.012, 0.008);

/// A flight in closed form, as a quadrotor makes it: thrust along the body's z axis, heading turning. Stands
/// still for two seconds, then winds up to 2 m/s.
struct Flight {
  static Vec3 position(double t) {
    const double u = std::max(0.0, t - 2);
    const double s = u * u * u * u / (u * u * u + 8);  // its speed rises to one; no step in jerk at the start
    return {2.6 * std::sin(0.6 * s), 1.3 * std::sin(1.2 * s), 0.4 * std::sin(0.9 * s)};
  }
  static Vec3 velocity(double t) { return (position(t + 1e-5) - position(t - 1e-5)) / 2e-5; }
  static Vec3 acceleration(double t) {
    constexpr double h = 1e-3;
    return (position(t + h) - 2 * position(t) + position(t - h)) / (h * h);
  }
  static Quat orientation(double t) {
    const double heading = 0.4 * std::max(0.0, t - 2);
    const Vec3 z = (acceleration(t) + Vec3(0, 0, 9.81)).normalized();
    const Vec3 x = Vec3(-std::sin(heading), std::cos(heading), 0).cross(z).normalized();
    Eigen::Matrix3d R;
    R << x, z.cross(x), z;
    return Quat(R);
  }
  static Vec3 body_rate(double t) {
    const Eigen::AngleAxisd d(orientation(t - 1e-4).conjugate() * orientation(t + 1e-4));
    return d.angle() * d.axis() / 2e-4;
  }
  static Vec3 specific_force(double t) {
    return orientation(t).conjugate() * (acceleration(t) + Vec3(0, 0, 9.81));
  }
};

}  // namespace karst::core
