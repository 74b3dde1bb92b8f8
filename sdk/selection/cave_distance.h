// Distance of two caves by their figures, in units of the spread of the known caves.
#pragma once
#include <vector>

#include "sdk/selection/experience.h"

namespace karst::selection {

/// Root of the weighted mean of the squared scaled differences over the figures known of both caves.
struct Distance {
  double value = kUnknown;  // NaN if they have no figure in common
  int farthest = -1;        // index of the figure that differs most
  int shared = 0;           // number of figures known of both
};

/// The unit of each figure: 1.4826 times the median absolute deviation over the known caves, but at least the
/// table's least scale.
std::vector<double> robust_scales(const std::vector<KnownCave>& caves);
Distance distance_between(const CaveFigures& a, const CaveFigures& b, const std::vector<double>& scales);

/// The greatest nearest-neighbour distance of the known caves: leaving caves out gives no evidence beyond it.
/// At least 0.7 units, which is less than the differences of randomly drawn caves.
double farthest_neighbour(const std::vector<KnownCave>& caves, const std::vector<double>& scales);

}  // namespace karst::selection
