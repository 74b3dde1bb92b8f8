// Quantiles of samples.
#pragma once
#include <algorithm>
#include <limits>
#include <vector>

namespace karst::preflight {

/// The sample of rank `fraction` (0..1); NaN if there is none. Samples must not be NaN.
inline double quantile(std::vector<double> samples, double fraction) {
  if (samples.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(samples.size() - 1) + 0.5);
  std::nth_element(samples.begin(), samples.begin() + rank, samples.end());
  return samples[static_cast<std::size_t>(rank)];
}
inline double median(std::vector<double> samples) { return quantile(std::move(samples), 0.5); }

}  // namespace karst::preflight
