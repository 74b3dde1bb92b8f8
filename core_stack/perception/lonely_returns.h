// Rock is smooth and dust is not: what no surface passes through is dropped, unless it is bright.
//
// For two beams that lie opposite each other at an angle a beside a third, a plane through their ends cuts
// the third at the range r with 1/r1 + 1/r2 = 2 cos(a) / r, at any incidence. Rock fulfils that in most
// directions, also at its edges and along them; a dust's echo comes from somewhere in a cloud and does in
// few. Bright returns stay whatever is around them, so that a lone wire or tip is not lost: no dust sends so
// much back. (DROR and LIOR, Charron et al. 2018 and Park et al. 2020, count near neighbours in space
// instead; that loses rock seen at a slant, and needs a search tree.)
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core {

struct LonelyReturnOptions {
  double agreement = 0.35;    // least share of the neighbours that lie on a surface with it
  double bright = 0.3;        // reflectivity, intensity corrected for range, of what is kept in any case
  double radius_m = 15;       // only returns nearer than this are judged
  double tolerance_m = 0.06;  // off the surface, at the sensor; grows by 6 mm a metre
};
void describe(OptionTable& t, LonelyReturnOptions& o);

/// Returns that fewer neighbours than asked agree with become NaN. Needs the scan's model; leaves a scan
/// alone whose arrays do not fit it.
void drop_lonely_returns(LidarScan& scan, const LonelyReturnOptions& options);

}  // namespace karst::core
