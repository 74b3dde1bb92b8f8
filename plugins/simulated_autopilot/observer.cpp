#include "plugins/simulated_autopilot/observer.h"

#include <algorithm>

#include "core_stack/common/so3.h"

namespace karst::sim {
namespace {

using core::Quat;
using core::Vec3;

const Vec3 kGravity(0, 0, 9.81);  // NED
// Fractions of the error that one pose corrects, at about 40 poses a second.
constexpr double kPosition = 0.2, kVelocity = 0.15, kAttitude = 0.08, kForceBias = 0.02, kRateBias = 0.02;
constexpr double kReset_m = 1;
constexpr core::TimeNs kTooOld = core::kSecond;

}  // namespace

std::optional<double> Observer::without_vision_s() const {
  if (!vision_at_) return std::nullopt;
  return core::seconds(motion_.stamp - *vision_at_);
}

bool Observer::position_known(double lasts_s) const {
  const auto s = without_vision_s();
  return s && *s < lasts_s;
}

/// At rest the measured force points up.
void Observer::level(const Vec3& force_frd) { motion_.attitude = Quat::FromTwoVectors(force_frd, -kGravity); }

void Observer::on_imu(core::TimeNs stamp, const Vec3& force_frd, const Vec3& rate_frd) {
  if (!started_) {
    level(force_frd);
    motion_.stamp = stamp;
    started_ = true;
    return;
  }
  const double dt_s = core::seconds(stamp - motion_.stamp);
  motion_.stamp = stamp;
  motion_.rate_radps = rate_frd - rate_bias_;
  motion_.attitude = (motion_.attitude * core::exp_so3(motion_.rate_radps * dt_s)).normalized();
  const Vec3 acceleration = motion_.attitude * (force_frd - force_bias_) + kGravity;
  if (vision_at_) {
    motion_.position += motion_.velocity_mps * dt_s + 0.5 * dt_s * dt_s * acceleration;
    motion_.velocity_mps += acceleration * dt_s;
  }
  past_.push_back(motion_);
}

void Observer::on_vision(core::TimeNs stamp, const Vec3& position, const Vec3& velocity_mps,
                         const Quat& attitude) {
  if (past_.empty() || stamp < motion_.stamp - kTooOld) return;
  const auto after = std::lower_bound(past_.begin(), past_.end(), stamp,
                                      [](const Motion& m, core::TimeNs t) { return m.stamp < t; });
  const Motion& then = after == past_.end() ? past_.back() : *after;
  const bool first = !vision_at_;
  const bool reset = first || (position - then.position).norm() > kReset_m;
  const Vec3 p = position - then.position, v = velocity_mps - then.velocity_mps;
  const Vec3 a = core::log_so3((then.attitude.conjugate() * attitude).normalized());  // body frame
  if (!reset) {
    force_bias_ -= kForceBias * (then.attitude.conjugate() * v);
    rate_bias_ -= kRateBias * a;
  }
  const Vec3 move = reset ? p : kPosition * p, push = reset ? v : kVelocity * v;
  // In the world frame, so that it holds for all attitudes since.
  const Quat turn = core::exp_so3(then.attitude * (reset ? a : kAttitude * a));
  double since_s = 0;
  for (auto m = past_.begin(); m != past_.end(); ++m) {
    if (m->stamp < then.stamp) continue;
    since_s = core::seconds(m->stamp - then.stamp);
    m->position += move + push * since_s;
    m->velocity_mps += push;
    m->attitude = (turn * m->attitude).normalized();
  }
  motion_ = past_.back();
  vision_at_ = vision_at_ ? std::max(*vision_at_, stamp) : stamp;
}

}  // namespace karst::sim
