#include "core_stack/perception/intensity_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace karst::core {

void describe(OptionTable& t, IntensityFilterOptions& o) {
  t.add("percentile", o.percentile, "%", 0, 100,
        "weakest share of a scan's returns that is suspected; 0: filter off");
  t.add("radius", o.radius_m, "m", 0, 100, "only returns nearer to the sensor than this are judged");
}

void filter_low_intensity(LidarScan& scan, const IntensityFilterOptions& options) {
  if (options.percentile <= 0 || scan.intensity.size() != scan.range_m.size()) return;
  std::vector<float> returned;
  returned.reserve(scan.range_m.size());
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (std::isfinite(scan.range_m[i]) && std::isfinite(scan.intensity[i]))
      returned.push_back(scan.intensity[i]);
  if (returned.empty()) return;

  // The percentile is the intensity that this share of the returns lies below.
  const auto rank =
      static_cast<std::size_t>(options.percentile / 100.0 * static_cast<double>(returned.size()));
  const auto at = returned.begin() + static_cast<std::ptrdiff_t>(std::min(rank, returned.size() - 1));
  std::nth_element(returned.begin(), at, returned.end());
  const float threshold = *at;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] < static_cast<float>(options.radius_m) && scan.intensity[i] < threshold)
      scan.range_m[i] = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace karst::core
