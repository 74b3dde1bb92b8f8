#include "sdk/evaluation/accuracy/error_statistics.h"

#include <algorithm>
#include <cmath>

namespace karst::evaluation {

ErrorStatistics statistics_of(std::vector<double> errors) {
  ErrorStatistics s;
  s.count = errors.size();
  if (errors.empty()) return s;
  std::sort(errors.begin(), errors.end());
  const double n = static_cast<double>(errors.size());
  double sum = 0, squares = 0, deviations = 0;
  for (const double e : errors) {
    sum += e;
    squares += e * e;
  }
  s.mean = sum / n;
  for (const double e : errors) deviations += (e - s.mean) * (e - s.mean);
  s.rmse = std::sqrt(squares / n);
  s.std = std::sqrt(deviations / n);
  s.min = errors.front();
  s.max = errors.back();
  const std::size_t middle = errors.size() / 2;
  s.median = errors.size() % 2 == 1 ? errors[middle] : (errors[middle - 1] + errors[middle]) / 2;
  return s;
}

}  // namespace karst::evaluation
