// The axes of passages, and where they meet.
#pragma once
#include <span>

#include "core_stack/common/geometry.h"
#include "sdk/survey_export/middle_line.h"

namespace karst::survey_export {

struct Axis {
  core::Vec3 place = core::Vec3::Zero(), direction = core::Vec3::UnitX();  // unit
};

/// The line with the least sum of squares of its distances to the points, two or more, from the first towards
/// the last.
Axis axis_of(std::span<const LinePoint> points);

/// The place with the least sum of squares of its distances to the axes and, by a small weight, to `held`:
/// axes that are nearly parallel meet anywhere.
core::Vec3 meeting_of(std::span<const Axis> axes, const core::Vec3& held);

}  // namespace karst::survey_export
