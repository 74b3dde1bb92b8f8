#include "sdk/selection/prediction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sdk/selection/cave_distance.h"

namespace karst::selection {
namespace {

constexpr double kMinFraction = 0.25;  // least fraction of the weight in which a contestant must have flown
const std::array kBandwidths{0.5, 0.7, 1.0, 1.4, 2.0, 3.0, std::numeric_limits<double>::infinity()};

double total_weight() {
  double sum = 0;
  for (const FigureDefinition& f : figure_definitions()) sum += f.weight;
  return sum;
}

double shared_weight(const CaveFigures& a, const CaveFigures& b) {
  double sum = 0;
  for (const FigureDefinition& f : figure_definitions())
    if (std::isfinite(a.*f.value) && std::isfinite(b.*f.value)) sum += f.weight;
  return sum;
}

}  // namespace

Values values_of(const Experience& e, std::size_t metric) {
  Values v{e.contestants.size(), e.caves.size(), {}, {}};
  for (std::size_t k = 0; k < v.contestants; ++k)
    for (std::size_t c = 0; c < v.caves; ++c) {
      const Fared& f = e.at(k, c, metric);
      v.mean.push_back(f.flights > 0 ? f.mean : kUnknown);
      v.error.push_back(std::isfinite(f.deviation) ? f.deviation / std::sqrt(f.flights) : 0.0);
    }
  return v;
}

std::vector<double> levels(const Values& v) {
  std::vector<bool> everywhere(v.contestants, true);
  for (std::size_t k = 0; k < v.contestants; ++k)
    for (std::size_t c = 0; c < v.caves; ++c)
      if (std::isnan(v.at(k, c))) everywhere[k] = false;
  const bool some = std::count(everywhere.begin(), everywhere.end(), true) > 0;
  std::vector<double> level(v.caves, kUnknown);
  for (std::size_t c = 0; c < v.caves; ++c) {
    double sum = 0;
    int n = 0;
    for (std::size_t k = 0; k < v.contestants; ++k)
      if (const double x = v.at(k, c); !std::isnan(x) && (everywhere[k] || !some)) {
        sum += x;
        ++n;
      }
    if (n > 0) level[c] = sum / n;
  }
  return level;
}

double predict(const Values& v, const std::vector<double>& level, const std::vector<double>& weight,
               std::size_t k) {
  double all = 0, levels = 0, flown = 0, advantages = 0;
  for (std::size_t c = 0; c < v.caves; ++c) {
    if (std::isnan(level[c])) continue;
    all += weight[c];
    levels += weight[c] * level[c];
    if (const double x = v.at(k, c); !std::isnan(x)) {
      flown += weight[c];
      advantages += weight[c] * (x - level[c]);
    }
  }
  return all > 0 && flown >= kMinFraction * all ? levels / all + advantages / flown : kUnknown;
}

std::vector<double> kernel_weights(const std::vector<KnownCave>& caves, const CaveFigures& cave,
                                   const Kernel& kernel) {
  std::vector<double> squared, weight;
  for (const KnownCave& known : caves) {
    const Distance d = distance_between(cave, known.figures, kernel.scales);
    squared.push_back(d.shared == 0
                          ? std::numeric_limits<double>::infinity()
                          : d.value * d.value * shared_weight(cave, known.figures) / total_weight());
  }
  // Relative to the nearest cave: far from everything, all weights would otherwise vanish.
  const double least = *std::min_element(squared.begin(), squared.end());
  const double h = kernel.bandwidth;
  for (const double s : squared)
    weight.push_back(std::isinf(s) ? 0.0 : std::exp(-0.5 * (s - least) / (h * h)));
  return weight;
}

std::vector<double> left_out_residuals(const Experience& e, const Values& v, const std::vector<double>& level,
                                       const Kernel& kernel, Predicted what) {
  std::vector<double> residuals(v.mean.size(), kUnknown);
  for (std::size_t c = 0; c < v.caves; ++c) {
    if (std::isnan(level[c])) continue;
    std::vector<KnownCave> others = e.caves;
    others[c].figures = {};  // of which nothing is known weighs nothing
    const std::vector<double> weight = kernel_weights(others, e.caves[c].figures, kernel);
    double expected_level = 0, all = 0;
    for (std::size_t o = 0; o < v.caves; ++o)
      if (!std::isnan(level[o])) {
        all += weight[o];
        expected_level += weight[o] * level[o];
      }
    for (std::size_t k = 0; k < v.contestants; ++k)
      if (!std::isnan(v.at(k, c)))
        residuals[k * v.caves + c] = v.at(k, c) - predict(v, level, weight, k) -
                                     (what == Predicted::advantage ? level[c] - expected_level / all : 0.0);
  }
  return residuals;
}

double best_bandwidth(const Experience& e, const Values& v, const std::vector<double>& level,
                      const std::vector<double>& scales) {
  Kernel kernel{scales, 0};
  double best = kBandwidths.back(), least = std::numeric_limits<double>::infinity();
  for (auto h = kBandwidths.rbegin(); h != kBandwidths.rend(); ++h) {
    kernel.bandwidth = *h;
    const std::vector<double> residuals = left_out_residuals(e, v, level, kernel, Predicted::advantage);
    double sum = 0;
    int n = 0;
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const double l = level[i % v.caves];
      if (std::isnan(residuals[i]) || l == 0) continue;
      sum += residuals[i] * residuals[i] / (l * l);
      ++n;
    }
    if (n > 0 && sum / n < least * (1 - 1e-9)) {
      least = sum / n;
      best = *h;
    }
  }
  return best;
}

}  // namespace karst::selection
