#include "sdk/selection/prediction.h"

#include <algorithm>
#include <cmath>

#include "sdk/selection/cave_distance.h"

namespace karst::selection {
namespace {

constexpr double kEnduranceSpread = 0.2;  // of the logarithm, for levels

/// Of a ratio; 1 if one of them is not given.
double likeness(double a, double b, double spread) {
  if (!(a > 0) || !(b > 0) || std::isinf(spread)) return 1;
  const double off = std::log(a / b) / spread;
  return std::exp(-0.5 * off * off);
}

bool differ(const std::string& a, const std::string& b) { return !a.empty() && !b.empty() && a != b; }

/// Squared distance by the kernel's figures; infinity if none of them is known of both.
double squared_distance(const CaveFigures& a, const CaveFigures& b, const Kernel& kernel) {
  double sum = 0, shared = 0, all = 0;
  for (std::size_t i = 0; i < figure_definitions().size(); ++i) {
    const FigureDefinition& f = figure_definitions()[i];
    const double w = kernel.weights[i];
    if (w == 0) continue;
    all += w;
    const double off = (scaled(f, a.*f.value) - scaled(f, b.*f.value)) / kernel.scales[i];
    if (std::isnan(off)) continue;
    sum += w * off * off;
    shared += w;
  }
  if (all == 0) return 0;
  return shared > 0 ? sum / all : std::numeric_limits<double>::infinity();
}

}  // namespace

Values values_of(const Experience& e, std::size_t metric) {
  Values v{e.contestants.size(), e.sites.size(), {}, {}};
  for (std::size_t k = 0; k < v.contestants; ++k)
    for (std::size_t s = 0; s < v.sites; ++s) {
      const Fared& f = e.at(k, s, metric);
      v.mean.push_back(f.flights > 0 ? f.mean : kUnknown);
      v.error.push_back(std::isfinite(f.deviation) ? f.deviation / std::sqrt(f.flights) : 0.0);
    }
  return v;
}

std::vector<double> levels(const Values& v) {
  // A site where nobody has this figure is no site of it.
  std::vector<bool> known(v.sites, false), everywhere(v.contestants, true);
  for (std::size_t k = 0; k < v.contestants; ++k)
    for (std::size_t s = 0; s < v.sites; ++s)
      if (!std::isnan(v.at(k, s))) known[s] = true;
  for (std::size_t k = 0; k < v.contestants; ++k)
    for (std::size_t s = 0; s < v.sites; ++s)
      if (known[s] && std::isnan(v.at(k, s))) everywhere[k] = false;
  const bool some = std::count(everywhere.begin(), everywhere.end(), true) > 0;
  std::vector<double> level(v.sites, kUnknown);
  for (std::size_t s = 0; s < v.sites; ++s) {
    double sum = 0;
    int n = 0;
    for (std::size_t k = 0; k < v.contestants; ++k)
      if (const double x = v.at(k, s); !std::isnan(x) && (everywhere[k] || !some)) {
        sum += x;
        ++n;
      }
    if (n > 0) level[s] = sum / n;
  }
  return level;
}

std::vector<double> cave_weights(const std::vector<KnownCave>& caves, const CaveFigures& cave,
                                 const Kernel& kernel) {
  std::vector<double> squared, weight;
  for (const KnownCave& known : caves) squared.push_back(squared_distance(cave, known.figures, kernel));
  // Relative to the nearest cave: far from everything, all weights would otherwise vanish.
  const double least = *std::min_element(squared.begin(), squared.end());
  if (std::isinf(least) || std::isinf(kernel.bandwidth)) return std::vector<double>(caves.size(), 1.0);
  const double h = kernel.bandwidth;
  for (const double s : squared)
    weight.push_back(std::isinf(s) ? 0.0 : std::exp(-0.5 * (s - least) / (h * h)));
  return weight;
}

std::vector<double> condition_weights(const std::vector<Condition>& conditions, const AskedConditions& a,
                                      const Kernel& kernel) {
  std::vector<double> weight;
  for (const Condition& c : conditions)
    weight.push_back(
        (differ(c.vehicle, a.vehicle)   ? kernel.other_vehicle
         : differ(c.sensors, a.sensors) ? kernel.other_sensors
                                        : 1.0) *
        likeness(c.endurance_s, a.endurance_s, kernel.endurance_spread) *
        likeness(static_cast<double>(c.robots), static_cast<double>(a.robots), kernel.team_spread));
  return weight;
}

std::vector<double> level_weights(const std::vector<Condition>& conditions, const AskedConditions& a) {
  const auto alike = [&](const Condition& c) {
    return !differ(c.vehicle, a.vehicle) && !differ(c.sensors, a.sensors) &&
           (a.robots == 0 || a.robots == c.robots);
  };
  const bool some = std::any_of(conditions.begin(), conditions.end(), alike);
  double nearest = std::numeric_limits<double>::infinity();
  const auto off = [&](const Condition& c) {
    return std::isnan(a.endurance_s) ? 0.0 : std::log(c.endurance_s / a.endurance_s) / kEnduranceSpread;
  };
  for (const Condition& c : conditions)
    if (alike(c) || !some) nearest = std::min(nearest, off(c) * off(c));
  std::vector<double> weight;
  for (const Condition& c : conditions)
    weight.push_back(alike(c) || !some ? std::exp(-0.5 * (off(c) * off(c) - nearest)) : 0.0);
  return weight;
}

SiteWeights site_weights(const Experience& e, const CaveFigures& cave, const AskedConditions& asked,
                         const Kernel& kernel) {
  const std::vector<double> of_cave = cave_weights(e.caves, cave, kernel),
                            of_condition = condition_weights(e.conditions, asked, kernel),
                            of_level = level_weights(e.conditions, asked);
  SiteWeights w;
  for (const Site& s : e.sites) {
    w.advantage.push_back(of_cave[s.cave] * of_condition[s.condition]);
    w.level.push_back(of_cave[s.cave] * of_level[s.condition]);
  }
  return w;
}

double predict(const Values& v, const std::vector<double>& level, const SiteWeights& weights, std::size_t k) {
  double levels = 0, of_levels = 0, all = 0, flown = 0, advantages = 0, of_advantages = 0;
  for (std::size_t s = 0; s < v.sites; ++s) {
    if (std::isnan(level[s])) continue;
    const double w = weights.advantage[s], x = v.at(k, s);
    levels += weights.level[s] * level[s];
    of_levels += weights.level[s];
    all += w;
    if (std::isnan(x)) continue;
    flown += w;
    if (!(level[s] > 0)) continue;
    advantages += w * x / level[s];
    of_advantages += w;
  }
  if (!(all > 0) || !(of_levels > 0) || flown < kMinFlownFraction * all) return kUnknown;
  return levels / of_levels * (of_advantages > 0 ? advantages / of_advantages : 1.0);
}

bool same_rock(const KnownCave& a, const KnownCave& b) {
  return a.name == b.name || (!a.hash.empty() && a.hash == b.hash);
}

std::vector<std::size_t> rocks_of(const Experience& e) {
  std::vector<std::size_t> rock(e.caves.size());
  for (std::size_t c = 0; c < rock.size(); ++c)
    while (rock[c] < c && !same_rock(e.caves[rock[c]], e.caves[c])) ++rock[c];
  return rock;
}

std::vector<double> left_out_residuals(const Experience& e, const Values& v, const std::vector<double>& level,
                                       const Kernel& kernel) {
  std::vector<double> residuals(v.mean.size(), kUnknown);
  for (std::size_t s = 0; s < v.sites; ++s) {
    if (std::isnan(level[s])) continue;
    const KnownCave& left_out = e.caves[e.sites[s].cave];
    SiteWeights w = site_weights(e, left_out.figures, asked(e.conditions[e.sites[s].condition]), kernel);
    for (std::size_t o = 0; o < v.sites; ++o)
      if (same_rock(e.caves[e.sites[o].cave], left_out)) w.advantage[o] = w.level[o] = 0;
    for (std::size_t k = 0; k < v.contestants; ++k)
      if (!std::isnan(v.at(k, s))) residuals[k * v.sites + s] = v.at(k, s) - predict(v, level, w, k);
  }
  return residuals;
}

}  // namespace karst::selection
