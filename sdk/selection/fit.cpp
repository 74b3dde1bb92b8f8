#include "sdk/selection/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sdk/selection/cave_distance.h"

namespace karst::selection {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array kBandwidths{0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0};
constexpr std::array kFactors{1.0, 0.3, 0.1, 0.03, 0.0};
constexpr std::array kSpreads{kInfinity, 1.0, 0.5, 0.25, 0.12};
constexpr int kMaxFigures = 4;

/// Errors of many kernels in the same experience.
class LeftOutCaves {
 public:
  LeftOutCaves(const Experience& e, const Values& v, const std::vector<double>& level) : e_(e), v_(v) {
    for (std::size_t s = 0; s < v.sites; ++s)
      for (std::size_t k = 0; k < v.contestants; ++k) {
        const double x = level[s] > 0 ? v.at(k, s) / level[s] : kUnknown;
        known_.push_back(std::isnan(x) ? 0 : 1);
        advantage_.push_back(std::isnan(x) ? 0 : x);
      }
  }

  /// The mean squared error in each cave; NaN where the metric is not known.
  std::vector<double> errors(const Kernel& kernel) const {
    const std::size_t caves = e_.caves.size(), conditions = e_.conditions.size();
    std::vector<double> of_cave, of_condition;
    for (const KnownCave& left_out : e_.caves) {
      std::vector<KnownCave> others = e_.caves;
      std::vector<double> w = cave_weights(others, left_out.figures, kernel);
      // The nearest of the others counts most, not the cave itself.
      double most = 0;
      for (std::size_t c = 0; c < caves; ++c) {
        if (same_rock(e_.caves[c], left_out)) w[c] = 0;
        most = std::max(most, w[c]);
      }
      for (double& x : w) x = most > 0 ? x / most : x;
      of_cave.insert(of_cave.end(), w.begin(), w.end());
    }
    for (const Condition& c : e_.conditions) {
      const std::vector<double> w = condition_weights(e_.conditions, asked(c), kernel);
      of_condition.insert(of_condition.end(), w.begin(), w.end());
    }
    std::vector<double> sum(caves, 0.0), n(caves, 0.0);
    std::vector<double> advantages(v_.contestants), flown(v_.contestants);
    for (std::size_t s = 0; s < v_.sites; ++s) {
      const Site& here = e_.sites[s];
      std::fill(advantages.begin(), advantages.end(), 0.0);
      std::fill(flown.begin(), flown.end(), 0.0);
      double all = 0;
      for (std::size_t o = 0; o < v_.sites; ++o) {
        const double w = of_cave[here.cave * caves + e_.sites[o].cave] *
                         of_condition[here.condition * conditions + e_.sites[o].condition];
        if (w < 1e-9) continue;
        all += w;
        const double* x = &advantage_[o * v_.contestants];
        const double* is = &known_[o * v_.contestants];
        for (std::size_t k = 0; k < v_.contestants; ++k) {
          advantages[k] += w * x[k];
          flown[k] += w * is[k];
        }
      }
      for (std::size_t k = 0; k < v_.contestants; ++k) {
        if (known_[s * v_.contestants + k] == 0) continue;
        // What cannot be predicted is taken for as good as the others.
        const bool predicted = flown[k] > 0 && flown[k] >= kMinFlownFraction * all;
        const double off = advantage_[s * v_.contestants + k] - (predicted ? advantages[k] / flown[k] : 1.0);
        sum[here.cave] += off * off;
        n[here.cave] += 1;
      }
    }
    for (std::size_t c = 0; c < caves; ++c) sum[c] = n[c] > 0 ? sum[c] / n[c] : kUnknown;
    return sum;
  }

 private:
  const Experience& e_;
  const Values& v_;
  std::vector<double> advantage_, known_;  // by site, contestant; known: 0 or 1
};

double mean(const std::vector<double>& errors) {
  double sum = 0;
  int n = 0;
  for (const double x : errors)
    if (!std::isnan(x)) {
      sum += x;
      ++n;
    }
  return n > 0 ? sum / n : kUnknown;
}

/// Whether `now` is less than `before` by more than the standard error of the difference over the caves.
bool clearly_less(const std::vector<double>& now, const std::vector<double>& before) {
  double sum = 0, squares = 0;
  int n = 0;
  for (std::size_t c = 0; c < now.size(); ++c)
    if (const double gain = before[c] - now[c]; !std::isnan(gain)) {
      sum += gain;
      squares += gain * gain;
      ++n;
    }
  if (n < 2) return false;
  const double gain = sum / n, variance = (squares - sum * gain) / (n - 1);
  return gain > 1e-9 * mean(before) && gain > std::sqrt(std::max(0.0, variance) / n);
}

/// A kernel with its errors.
struct Candidate {
  Kernel kernel;
  std::vector<double> errors;
};

template <class Values, class Member>
void choose(const LeftOutCaves& caves, Candidate& best, const Values& values, Member Kernel::*member) {
  for (const double value : values) {
    Kernel kernel = best.kernel;
    kernel.*member = value;
    std::vector<double> errors = caves.errors(kernel);
    if (mean(errors) < mean(best.errors) * (1 - 1e-9)) best = {kernel, std::move(errors)};
  }
}

template <class Differ>
bool some_differ(const std::vector<Condition>& conditions, const Differ& differ) {
  return std::any_of(conditions.begin(), conditions.end(),
                     [&](const Condition& c) { return differ(c, conditions.front()); });
}

/// How much flights under other conditions count.
void choose_conditions(const Experience& e, const LeftOutCaves& caves, Candidate& best) {
  using C = Condition;
  if (some_differ(e.conditions, [](const C& a, const C& b) { return a.vehicle != b.vehicle; }))
    choose(caves, best, kFactors, &Kernel::other_vehicle);
  if (some_differ(e.conditions, [](const C& a, const C& b) { return a.sensors != b.sensors; }))
    choose(caves, best, kFactors, &Kernel::other_sensors);
  if (some_differ(e.conditions, [](const C& a, const C& b) { return a.endurance_s != b.endurance_s; }))
    choose(caves, best, kSpreads, &Kernel::endurance_spread);
  if (some_differ(e.conditions, [](const C& a, const C& b) { return a.robots != b.robots; }))
    choose(caves, best, kSpreads, &Kernel::team_spread);
}

/// The best bandwidth for these figures.
Candidate with_figures(const LeftOutCaves& caves, const Kernel& kernel, std::vector<double> weights) {
  Candidate best;
  for (const double bandwidth : kBandwidths) {
    Kernel k = kernel;
    k.weights = weights;
    k.bandwidth = bandwidth;
    std::vector<double> errors = caves.errors(k);
    if (best.errors.empty() || mean(errors) < mean(best.errors)) best = {std::move(k), std::move(errors)};
  }
  return best;
}

void choose_figures(const Experience& e, const LeftOutCaves& caves, Candidate& best) {
  const std::size_t figures = figure_definitions().size();
  std::vector<double> all;
  for (const FigureDefinition& f : figure_definitions()) {
    const bool known = std::any_of(e.caves.begin(), e.caves.end(),
                                   [&](const KnownCave& c) { return std::isfinite(c.figures.*f.value); });
    all.push_back(known ? f.weight : 0);
  }
  const Candidate none = best;
  for (int n = 0; n < kMaxFigures; ++n) {
    std::optional<Candidate> next;
    for (std::size_t f = 0; f < figures; ++f) {
      if (all[f] == 0 || best.kernel.weights[f] > 0) continue;
      std::vector<double> weights = best.kernel.weights;
      weights[f] = 1;
      Candidate with = with_figures(caves, best.kernel, std::move(weights));
      if (!next || mean(with.errors) < mean(next->errors)) next = std::move(with);
    }
    if (!next || !clearly_less(next->errors, best.errors)) break;
    best = std::move(*next);
  }
  Candidate with_all = with_figures(caves, none.kernel, all);
  if (clearly_less(with_all.errors, none.errors) && mean(with_all.errors) < mean(best.errors))
    best = std::move(with_all);
}

}  // namespace

Fit fit(const Experience& e, const Values& v, const std::vector<double>& level) {
  const LeftOutCaves caves(e, v, level);
  Candidate best;
  best.kernel.scales = robust_scales(e.caves);
  best.kernel.weights.assign(figure_definitions().size(), 0.0);
  best.errors = caves.errors(best.kernel);
  choose_conditions(e, caves, best);
  const double all_alike = mean(best.errors);
  choose_figures(e, caves, best);
  if (!std::isinf(best.kernel.bandwidth)) choose_conditions(e, caves, best);
  return {best.kernel, mean(best.errors), all_alike};
}

}  // namespace karst::selection
