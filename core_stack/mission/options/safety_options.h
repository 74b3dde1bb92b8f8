// When the safety supervisor acts.
#pragma once
#include "core_stack/common/options.h"

namespace karst::core {

struct SafetyOptions {
  double slow_fraction = 0.5;    // of motion.max_speed or 2 m/s, while slowed
  double tracking_slow_m = 0.4;  // distance of the estimate from the reference
  double tracking_brake_m = 0.8;
  double hull_clearance_m = 0.1;  // slow below this distance of the hull from obstacles
  double blind_brake_s = 1.0;     // without a scan or an image
  double blind_home_s = 10.0;
  double degraded_home_s = 5.0;  // of a degraded state estimate
  double battery_land_s = 12.0;  // lands wherever it is
};
void describe(OptionTable& t, SafetyOptions& o);

}  // namespace karst::core
