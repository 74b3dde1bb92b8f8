#include "sdk/selection/cave_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace karst::selection {

constexpr double kNear = 0.7;  // units

std::vector<double> robust_scales(const std::vector<KnownCave>& caves) {
  const auto median = [](std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v.size() % 2 ? v[v.size() / 2] : (v[v.size() / 2 - 1] + v[v.size() / 2]) / 2;
  };
  std::vector<double> scales;
  for (const FigureDefinition& f : figure_definitions()) {
    std::vector<double> values;
    for (const KnownCave& c : caves)
      if (std::isfinite(c.figures.*f.value)) values.push_back(scaled(f, c.figures.*f.value));
    double scale = f.min_scale;
    if (!values.empty()) {
      const double middle = median(values);
      for (double& v : values) v = std::abs(v - middle);
      scale = std::max(scale, 1.4826 * median(values));
    }
    scales.push_back(scale);
  }
  return scales;
}

Distance distance_between(const CaveFigures& a, const CaveFigures& b, const std::vector<double>& scales) {
  Distance d;
  double sum = 0, weights = 0, largest = -1;
  for (std::size_t i = 0; i < figure_definitions().size(); ++i) {
    const FigureDefinition& f = figure_definitions()[i];
    if (!std::isfinite(a.*f.value) || !std::isfinite(b.*f.value)) continue;
    const double off = (scaled(f, a.*f.value) - scaled(f, b.*f.value)) / scales[i],
                 square = f.weight * off * off;
    sum += square;
    weights += f.weight;
    ++d.shared;
    if (square > largest) {
      largest = square;
      d.farthest = static_cast<int>(i);
    }
  }
  if (d.shared > 0) d.value = std::sqrt(sum / weights);
  return d;
}

double farthest_neighbour(const std::vector<KnownCave>& caves, const std::vector<double>& scales) {
  double limit = kNear;
  for (std::size_t a = 0; a < caves.size(); ++a) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < caves.size(); ++b)
      if (const Distance d = distance_between(caves[a].figures, caves[b].figures, scales);
          a != b && d.shared > 0)
        nearest = std::min(nearest, d.value);
    if (std::isfinite(nearest)) limit = std::max(limit, nearest);
  }
  return limit;
}

}  // namespace karst::selection
