// The rule of lonely_returns.h for scans without rings: a point's neighbours are those near its direction.
//
// Two neighbours are opposite each other if the angle between their offsets from the point is more than 143
// degrees; they need not be equally far. For beams at the angles a and b on either side of a third, a plane
// through their ends cuts the third at the range r with sin(a + b) / r = sin(b) / r1 + sin(a) / r2.
#pragma once
#include "core_stack/perception/lonely_returns.h"

namespace karst::core {

/// Points that fewer neighbours than asked agree with become NaN. Needs the directions of the points, and the
/// intensities; leaves a scan without them as it is.
void drop_lonely_points(LidarScan& scan, const LonelyReturnOptions& options);

}  // namespace karst::core
