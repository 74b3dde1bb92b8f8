// Dust and droplets return little light: near the sensor, the weakest returns of a scan are dropped.
// Section III-A of the paper.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/vehicle/messages.h"

namespace karst::core {

struct IntensityFilterOptions {
  double percentile = 10.0;  // of the scan's intensities; 0 switches the filter off
  double radius_m = 1.5;     // only returns nearer than this are judged
};
void describe(OptionTable& t, IntensityFilterOptions& o);

/// Returns nearer than the radius whose intensity lies below the percentile of all the scan's returns become
/// NaN.
void filter_low_intensity(LidarScan& scan, const IntensityFilterOptions& options);

}  // namespace karst::core
