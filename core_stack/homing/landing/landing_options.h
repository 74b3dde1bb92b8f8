// The mission file's section `homing.landing`: where a robot may land as a relay.
#pragma once
#include "core_stack/homing/landing/landing_ground.h"
#include "core_stack/homing/landing/link_estimate.h"

namespace karst::core {

struct LandingOptions {
  GroundOptions ground;
  LinkEstimateOptions link;
  double separation_m = 2.0;       // from sites where others stand or that they claim
  double passage_radius_m = 3.0;   // others must be able to pass within this radius
  double landing_speed_mps = 0.4;  // mission.landing_speed
};
void describe(OptionTable& t, LandingOptions& o);

}  // namespace karst::core
