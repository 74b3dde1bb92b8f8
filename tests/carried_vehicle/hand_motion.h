// How a person moves a vehicle in front of them: first it stands, then it is lifted, rolled, nodded and
// turned, all at once and each at its own pace.
#pragma once
#include "core_stack/common/geometry.h"
#include "core_stack/common/random.h"
#include "core_stack/common/time.h"

namespace karst::test {

class HandMotion {
 public:
  HandMotion(const core::Pose& T_world_start, core::TimeNs begins, core::Random random);
  core::Pose at(core::TimeNs t) const;

 private:
  core::Pose T_world_start_;
  core::TimeNs begins_;
  core::Vec3 turn_phase_, turn_hz_, shift_phase_;
};

}  // namespace karst::test
