#include "sdk/evaluation/page/decimate.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace karst::evaluation {

Curve decimate(const std::vector<double>& x, const std::vector<double>& y, std::size_t max_points) {
  Curve all;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    all.x.push_back(x[i]);
    all.y.push_back(y[i]);
  }
  const std::size_t n = all.x.size();
  if (n <= max_points || max_points < 4) return all;
  const std::size_t runs = max_points / 4;
  Curve kept;
  for (std::size_t r = 0; r < runs; ++r) {
    const std::size_t begin = r * n / runs, end = (r + 1) * n / runs;
    const auto from = all.y.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto to = all.y.begin() + static_cast<std::ptrdiff_t>(end);
    const auto [least, greatest] = std::minmax_element(from, to);
    const std::set<std::size_t> chosen{begin, static_cast<std::size_t>(least - all.y.begin()),
                                       static_cast<std::size_t>(greatest - all.y.begin()), end - 1};
    for (const std::size_t i : chosen) {
      kept.x.push_back(all.x[i]);
      kept.y.push_back(all.y[i]);
    }
  }
  return kept;
}

}  // namespace karst::evaluation
