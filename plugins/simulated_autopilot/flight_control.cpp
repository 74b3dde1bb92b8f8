#include "plugins/simulated_autopilot/flight_control.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/so3.h"

namespace karst::sim {
namespace {

using core::at_most;
using core::Quat;
using core::Vec3;

constexpr double kWeight_mps2 = 9.81;
const Vec3 kPositionGain(0.95, 0.95, 1.0), kVelocityGain(1.8, 1.8, 4.0), kIntegralGain(0.4, 0.4, 2.0);
constexpr double kMaxIntegral_mps2 = 4, kMaxSpeed_mps = 5, kMaxTilt = 0.7;  // tangent: 35 degrees
const Vec3 kAttitudeGain(6.5, 6.5, 2.8);
constexpr double kMaxRate_radps = 3.8, kMaxYawRate_radps = 3.5;

}  // namespace

double yaw_of(const Quat& attitude) {
  const Vec3 forward = attitude * Vec3::UnitX();
  return std::atan2(forward.y(), forward.x());
}

RateTarget FlightControl::follow(const PositionTarget& t, const Motion& m, double dt_s) {
  Vec3 velocity = t.velocity_mps;
  if (t.position) velocity += kPositionGain.cwiseProduct(*t.position - m.position);
  const Vec3 error = at_most(velocity, kMaxSpeed_mps) - m.velocity_mps;
  integral_mps2_ += dt_s * kIntegralGain.cwiseProduct(error);
  integral_mps2_ = integral_mps2_.cwiseMax(-kMaxIntegral_mps2).cwiseMin(kMaxIntegral_mps2);
  const Vec3 acceleration = t.acceleration_mps2 + kVelocityGain.cwiseProduct(error) + integral_mps2_;
  Vec3 force = acceleration - Vec3(0, 0, kWeight_mps2);
  force.z() = std::clamp(force.z(), -2 * kWeight_mps2, -0.3 * kWeight_mps2);  // it never turns over
  const double sideways = force.head<2>().norm(), most = -kMaxTilt * force.z();
  if (sideways > most) force.head<2>() *= most / sideways;
  return turn_to(force, t.yaw_rad, t.yaw_rate_radps, m);
}

RateTarget FlightControl::level(double climb_mps, const Motion& m, double dt_s) {
  const double error = -climb_mps - m.velocity_mps.z();
  integral_mps2_.z() = std::clamp(integral_mps2_.z() + dt_s * kIntegralGain.z() * error, -kMaxIntegral_mps2,
                                  kMaxIntegral_mps2);
  const double down = kVelocityGain.z() * error + integral_mps2_.z();
  return turn_to({0, 0, std::clamp(down - kWeight_mps2, -2 * kWeight_mps2, -0.3 * kWeight_mps2)},
                 yaw_of(m.attitude), 0, m);
}

/// The attitude whose downward axis is opposite to the force and whose nose points to the yaw.
RateTarget FlightControl::turn_to(const Vec3& force, double yaw_rad, double yaw_rate_radps,
                                  const Motion& m) const {
  const Vec3 z = -force.normalized();
  const Vec3 right(-std::sin(yaw_rad), std::cos(yaw_rad), 0);
  const Vec3 x = right.cross(z).normalized(), y = z.cross(x);
  Eigen::Matrix3d R;
  R << x, y, z;
  const Vec3 error = core::log_so3((m.attitude.conjugate() * Quat(R)).normalized());
  RateTarget out;
  out.rate_radps =
      kAttitudeGain.cwiseProduct(error) + yaw_rate_radps * (m.attitude.conjugate() * Vec3::UnitZ());
  out.rate_radps.head<2>() = out.rate_radps.head<2>().cwiseMax(-kMaxRate_radps).cwiseMin(kMaxRate_radps);
  out.rate_radps.z() = std::clamp(out.rate_radps.z(), -kMaxYawRate_radps, kMaxYawRate_radps);
  // Of the force, what the present attitude can exert along its own axis.
  const double along = std::max(0.0, force.dot(m.attitude * -Vec3::UnitZ()));
  out.thrust = std::clamp(hover_thrust_ * along / kWeight_mps2, 0.0, 1.0);
  return out;
}

}  // namespace karst::sim
