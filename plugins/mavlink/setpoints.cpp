#include "plugins/mavlink/setpoints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plugins/mavlink/ned.h"

namespace karst::mavlink {
namespace {

using core::Quat;
using core::Vec3;

float f(double v) { return static_cast<float>(v); }

std::array<float, 4> wxyz(const Quat& q) { return {f(q.w()), f(q.x()), f(q.y()), f(q.z())}; }

}  // namespace

std::uint32_t boot_ms(core::TimeNs time) { return static_cast<std::uint32_t>(time / core::kMillisecond); }

SetAttitudeTarget rates_target(const core::AttitudeRateCommand& rates, double thrust_per_n,
                               core::TimeNs now) {
  SetAttitudeTarget m;
  m.time_boot_ms = boot_ms(now);
  m.type_mask = kIgnoreAttitude;
  m.q = {1, 0, 0, 0};
  const Vec3 w = frd_of_flu(rates.body_rate_radps);
  m.body_roll_rate = f(w.x()), m.body_pitch_rate = f(w.y()), m.body_yaw_rate = f(w.z());
  m.thrust = rates.armed ? f(std::clamp(rates.thrust_n * thrust_per_n, 0.0, 1.0)) : 0;
  return m;
}

SetPositionTargetLocalNed position_target(const core::Reference& r, double ahead_s, core::TimeNs now) {
  SetPositionTargetLocalNed m;
  m.time_boot_ms = boot_ms(now);
  m.coordinate_frame = kLocalNed;
  const Vec3 p =
      ned_of_enu(r.position + ahead_s * r.velocity_mps + ahead_s * ahead_s / 2 * r.acceleration_mps2);
  const Vec3 v = ned_of_enu(r.velocity_mps + ahead_s * r.acceleration_mps2);
  const Vec3 a = ned_of_enu(r.acceleration_mps2);
  m.x = f(p.x()), m.y = f(p.y()), m.z = f(p.z());
  m.vx = f(v.x()), m.vy = f(v.y()), m.vz = f(v.z());
  m.afx = f(a.x()), m.afy = f(a.y()), m.afz = f(a.z());
  m.yaw = f(yaw_of_heading(r.heading_rad + ahead_s * r.heading_rate_radps));
  m.yaw_rate = f(-r.heading_rate_radps);
  return m;
}

Odometry vision(const core::State& s, std::uint8_t resets) {
  Odometry m;
  m.reset_counter = resets;
  m.time_usec = static_cast<std::uint64_t>(s.stamp / 1000);
  const Vec3 p = ned_of_enu(s.position);
  m.x = f(p.x()), m.y = f(p.y()), m.z = f(p.z());
  m.q = wxyz(ned_frd_of_enu_flu(s.orientation));
  const Vec3 v = frd_of_flu(s.orientation.conjugate() * s.velocity_mps), w = frd_of_flu(s.body_rate_radps);
  m.vx = f(v.x()), m.vy = f(v.y()), m.vz = f(v.z());
  m.rollspeed = f(w.x()), m.pitchspeed = f(w.y()), m.yawspeed = f(w.z());
  m.pose_covariance[0] = m.velocity_covariance[0] = std::numeric_limits<float>::quiet_NaN();  // not given
  m.frame_id = kLocalFrd;
  m.child_frame_id = kBodyFrd;
  m.estimator_type = kVision;
  m.quality = 100;
  return m;
}

}  // namespace karst::mavlink
