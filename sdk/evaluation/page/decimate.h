// Reduces the samples of a curve without changing its drawn shape.
#pragma once
#include <vector>

namespace karst::evaluation {

struct Curve {
  std::vector<double> x, y;
};

/// At most about `max_points` samples: the x range is cut into equal bins, and the first, least, greatest and
/// last sample of each bin are kept, so that no peak is lost. Samples that are not finite are left out.
Curve decimate(const std::vector<double>& x, const std::vector<double>& y, std::size_t max_points);

}  // namespace karst::evaluation
