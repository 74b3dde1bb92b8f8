#include "core_stack/perception/intensity_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace karst::core {

void describe(OptionTable& t, IntensityFilterOptions& o) {
  t.add("rule", o.rule,
        "which returns are taken for dust: those no surface passes through, or the weakest near the sensor");
  t.add("percentile", o.percentile, "%", 0, 100,
        "weakest share of a scan's returns that the rule percentile suspects; 0: none");
  t.add("radius", o.radius_m, "m", 0, 100, "that rule judges only returns nearer to the sensor than this");
  t.section("lonely", o.lonely);
}

void filter_low_intensity(LidarScan& scan, const IntensityFilterOptions& options) {
  if (options.rule == DustRule::percentile || options.rule == DustRule::both)
    drop_weakest_returns(scan, options.percentile, options.radius_m);
  if (options.rule == DustRule::lonely || options.rule == DustRule::both)
    drop_lonely_returns(scan, options.lonely);
}

void drop_weakest_returns(LidarScan& scan, double percentile, double radius_m) {
  if (percentile <= 0 || scan.intensity.size() != scan.range_m.size()) return;
  std::vector<float> returned;
  returned.reserve(scan.range_m.size());
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (std::isfinite(scan.range_m[i]) && std::isfinite(scan.intensity[i]))
      returned.push_back(scan.intensity[i]);
  if (returned.empty()) return;

  // The percentile is the intensity that this share of the returns lies below.
  const auto rank = static_cast<std::size_t>(percentile / 100.0 * static_cast<double>(returned.size()));
  const auto at = returned.begin() + static_cast<std::ptrdiff_t>(std::min(rank, returned.size() - 1));
  std::nth_element(returned.begin(), at, returned.end());
  const float threshold = *at;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] < static_cast<float>(radius_m) && scan.intensity[i] < threshold)
      scan.range_m[i] = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace karst::core
