#include "core_stack/localization/compass.h"

#include <algorithm>
#include <cmath>

namespace karst::core {
namespace {

/// Samples until the field counts as known, and the length in samples of its running average.
constexpr int kKnown = 20, kAverage = 3000;
/// Within a cave the earth's field varies by less than this, sensor noise and tilt error included.
constexpr double kStrengthFraction = 0.08, kDip_rad = 0.07;
/// Towards the poles the horizontal component is too weak to give a heading.
constexpr double kMinHorizontal_ut = 5;
/// The compass is not trusted after this time without a sample.
constexpr TimeNs kSilent = kSecond / 5;

double dip(const Vec3& field) { return std::atan2(-field.z(), field.head<2>().norm()); }
double bearing(const Vec3& field) { return std::atan2(field.y(), field.x()); }

}  // namespace

bool Compass::fits(const Vec3& field) const {
  return std::abs(field.norm() - field_world_ut_.norm()) < kStrengthFraction * field_world_ut_.norm() &&
         std::abs(dip(field) - dip(field_world_ut_)) < kDip_rad &&
         field_world_ut_.head<2>().norm() > kMinHorizontal_ut;
}

Compass::Reading Compass::read(const MagnetometerSample& sample, const Quat& orientation) {
  Reading out;
  last_read_ = sample.stamp;
  const Vec3 field_world = orientation * sample.field_ut;
  out.valid = learnt_ >= kKnown && field_world.allFinite() && fits(field_world);
  if (out.valid != trusted_) trusted_since_ = sample.stamp;
  trusted_ = out.valid;
  if (out.valid)
    out.heading_rad = wrap_angle(heading_of(orientation) + bearing(field_world_ut_) - bearing(field_world));
  return out;
}

void Compass::learn(const MagnetometerSample& sample, const Quat& orientation) {
  const Vec3 field_world = orientation * sample.field_ut;
  if (!field_world.allFinite() || (learnt_ >= kKnown && !fits(field_world))) return;
  learnt_ = std::min(learnt_ + 1, kAverage);
  field_world_ut_ += (field_world - field_world_ut_) / learnt_;
}

double Compass::trusted_s(TimeNs now) const {
  return trusted_ && now - last_read_ < kSilent ? seconds(now - trusted_since_) : 0;
}

void Compass::forget() { *this = {}; }

}  // namespace karst::core
