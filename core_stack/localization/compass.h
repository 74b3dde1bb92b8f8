// Heading from the magnetometer, and a test whether the heading can be trusted: ore distorts the field.
//
// The field in the world frame is learnt while the heading is known. A reading counts as disturbed if its
// strength or its dip differs from the learnt field. A disturbance that only turns the field about the
// vertical passes this test; only the LiDAR can contradict it.
#pragma once
#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core {

class Compass {
 public:
  struct Reading {
    bool valid = false;      // the field of the world is known, and the reading agrees with it
    double heading_rad = 0;  // heading of the body in the world frame
  };
  /// Computes the heading from a sample; only the roll and pitch of `orientation` (body to world) are used.
  Reading read(const MagnetometerSample& sample, const Quat& orientation);
  /// Adds a sample to the average field; the heading of `orientation` (body to world) must be known.
  void learn(const MagnetometerSample& sample, const Quat& orientation);
  /// Time in seconds for which all readings have been valid.
  double trusted_s(TimeNs now) const;
  /// Discards the learnt field after the LiDAR has contradicted it.
  void forget();

 private:
  bool fits(const Vec3& field_world_ut) const;

  Vec3 field_world_ut_ = Vec3::Zero();
  int learnt_ = 0;
  TimeNs trusted_since_ = 0, last_read_ = 0;
  bool trusted_ = false;
};

}  // namespace karst::core
