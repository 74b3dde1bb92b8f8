// Heading from the magnetometer, and whether to believe it: near ore the field bends.
//
// The field of the world is learnt where the heading is known. A reading is disturbed if its strength or its
// dip differ from that field's; a field that is only turned about the vertical looks undisturbed, and it is
// for the LiDAR to contradict it.
#pragma once
#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core {

class Compass {
 public:
  struct Reading {
    bool valid = false;      // the field of the world is known, and this is it
    double heading_rad = 0;  // of the body
  };
  /// Heading by a sample; of `orientation` only roll and pitch count.
  Reading read(const MagnetometerSample& sample, const Quat& orientation);
  /// Takes in a sample made at an orientation whose heading is known.
  void learn(const MagnetometerSample& sample, const Quat& orientation);
  /// Readings have been valid for as long as that.
  double trusted_s(TimeNs now) const;
  /// Contradicted: the field is learnt anew.
  void forget();

 private:
  bool fits(const Vec3& field_world_ut) const;

  Vec3 field_world_ut_ = Vec3::Zero();
  int learnt_ = 0;
  TimeNs trusted_since_ = 0, last_read_ = 0;
  bool trusted_ = false;
};

}  // namespace karst::core
