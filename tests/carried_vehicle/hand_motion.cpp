#include "tests/carried_vehicle/hand_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core_stack/common/so3.h"

namespace karst::test {

using core::Quat;
using core::Vec3;

namespace {

constexpr double kTwoPi = 2 * std::numbers::pi, kLift_m = 0.6, kBlend_s = 2.5;
const Vec3 kTurn_rad(0.5, 0.45, 1.1), kShift_m(0.12, 0.12, 0.08);  // roll, pitch, heading

Vec3 phases(core::Random& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return kTwoPi * Vec3(x, y, z);
}

/// From 0 to 1 with no jump in the first two derivatives.
double blend(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * t * (10 - 15 * t + 6 * t * t);
}

}  // namespace

HandMotion::HandMotion(const core::Pose& T_world_start, core::TimeNs begins, core::Random random)
    : T_world_start_(T_world_start), begins_(begins) {
  turn_phase_ = phases(random);
  shift_phase_ = phases(random);
  for (int axis = 0; axis < 3; ++axis)
    turn_hz_[axis] = Vec3(0.23, 0.29, 0.13)[axis] * random.uniform(0.9, 1.1);
}

core::Pose HandMotion::at(core::TimeNs t) const {
  const double since_s = core::seconds(t - begins_);
  if (since_s <= 0) return T_world_start_;
  const double w = blend(since_s / kBlend_s);
  const Vec3 angle =
      w * kTurn_rad.cwiseProduct((kTwoPi * turn_hz_ * since_s + turn_phase_).array().sin().matrix());
  const Vec3 shift =
      w * (kShift_m.cwiseProduct((Vec3(2.1, 2.7, 3.3) * since_s + shift_phase_).array().sin().matrix()) +
           kLift_m * Vec3::UnitZ());
  const Quat turn = core::exp_so3(angle.z() * Vec3::UnitZ()) * core::exp_so3(angle.y() * Vec3::UnitY()) *
                    core::exp_so3(angle.x() * Vec3::UnitX());
  return {T_world_start_.position + shift, (T_world_start_.orientation * turn).normalized()};
}

}  // namespace karst::test
