// Features of a sweep without rings: of the Mid-360 and its like, whose points are neighbours only by
// direction.
//
// The window around a point holds the points around its direction, as far along the rock as the window of a
// ring (features.h). With u and v the offsets in direction, their ranges are fitted by
//
//   r = a + g' (u, v)
//
//   sharpness = |a - r_0| / half the window's length
//
// where r_0 is the range at the point itself, with its nearest points. As for rings, it is 0 on a plane and
// 0.3 at the tip of a right angle. The slope |g| / a is the tangent of the angle between beam and normal.
//
// A point has no sharpness if its window is not all around it (the border of the field of view, or a hole),
// if the ranges in the window have a gap (an occlusion), or if its beam grazes the rock.
//
// The flattest point of each cell of 4 degrees, and the sharpest one of 8 degrees, become features.
#pragma once
#include "core_stack/localization/features.h"

namespace karst::core {

/// Points must be finite and not zero. `threads` affects the run time, not the result. About the `fraction`
/// of the features is found, in cells larger by 1 / sqrt(fraction).
Features find_unordered_features(const std::vector<SweepPoint>& points, const FeatureOptions& options,
                                 int threads, double fraction = 1);

}  // namespace karst::core
