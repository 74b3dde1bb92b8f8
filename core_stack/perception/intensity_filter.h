// Dust and droplets return little light, and from anywhere: near the sensor, what looks like them is dropped.
//
// Two rules. `percentile` is the paper's (section III-A): within a local neighbourhood of the sensor, the
// returns below the 10th percentile of the scan's intensities. `lonely` asks each return's neighbours as well
// (lonely_returns.h). docs/perception.md compares them.
#pragma once
#include "core_stack/perception/lonely_returns.h"

namespace karst::core {

enum class DustRule { lonely, percentile, both, none };
constexpr auto names_of(DustRule) {
  using enum DustRule;
  return std::to_array<Named<DustRule>>(
      {{lonely, "lonely"}, {percentile, "percentile"}, {both, "both"}, {none, "none"}});
}

struct IntensityFilterOptions {
  double percentile = 10.0;  // of the scan's intensities; 0 switches that rule off
  double radius_m = 1.5;     // that rule judges only returns nearer than this
  DustRule rule = DustRule::lonely;
  LonelyReturnOptions lonely;
};
void describe(OptionTable& t, IntensityFilterOptions& o);

/// Returns nearer than the radius whose intensity lies below the percentile of all the scan's returns become
/// NaN.
void drop_weakest_returns(LidarScan& scan, double percentile, double radius_m);

/// By the rule chosen.
void filter_low_intensity(LidarScan& scan, const IntensityFilterOptions& options);

}  // namespace karst::core
