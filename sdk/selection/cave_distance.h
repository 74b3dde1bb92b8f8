// How far apart two caves are, figure by figure, in units of what known caves differ by.
#pragma once
#include <vector>

#include "sdk/selection/experience.h"

namespace karst::selection {

/// Root of the weighted mean of the squared scaled differences over the figures both caves have.
struct Distance {
  double value = kUnknown;  // NaN if they have no figure in common
  int farthest = -1;        // index of the figure that differs most
  int shared = 0;           // figures both have
};

/// The unit of each figure: 1.4826 times the median absolute deviation over the known caves, not less than
/// the table's least scale.
std::vector<double> robust_scales(const std::vector<KnownCave>& caves);
Distance distance_between(const CaveFigures& a, const CaveFigures& b, const std::vector<double>& scales);

/// The largest distance at which a cave's nearest other one lies: leaving caves out shows nothing of larger
/// ones. At least 0.7 units, less than caves drawn at random differ by.
double farthest_neighbour(const std::vector<KnownCave>& caves, const std::vector<double>& scales);

}  // namespace karst::selection
