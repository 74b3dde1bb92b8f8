// Statistics of a set of errors: the figures that the evo tool prints.
#pragma once
#include <cstddef>
#include <vector>

namespace karst::evaluation {

struct ErrorStatistics {
  std::size_t count = 0;
  double rmse = 0, mean = 0, median = 0, std = 0, min = 0, max = 0;  // std: of the population
};

/// All zero if there are no errors. The median of an even number is the mean of the middle two.
ErrorStatistics statistics_of(std::vector<double> errors);

}  // namespace karst::evaluation
