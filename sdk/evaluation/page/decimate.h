// Fewer samples of a curve that still draw the same curve.
#pragma once
#include <vector>

namespace karst::evaluation {

struct Curve {
  std::vector<double> x, y;
};

/// At most about `max_points` samples: the x range is cut into equal runs of samples, and of each run the
/// first, least, greatest and last are kept, so no peak is lost. Samples that are not finite are left out.
Curve decimate(const std::vector<double>& x, const std::vector<double>& y, std::size_t max_points);

}  // namespace karst::evaluation
