#include "sdk/selection/select.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/selection/prediction.h"
#include "sdk/selection/select_words.h"

namespace karst::selection {
namespace {

using core::InputError;

constexpr int kResamples = 1000;
constexpr int kTellingFigures = 6;  // least number of known figures to identify a cave by equal figures

std::size_t metric_of(const Experience& e, const std::string& name, const std::string& source) {
  const auto found = std::find(e.metrics.begin(), e.metrics.end(), name);
  if (found == e.metrics.end()) {
    const std::string near = core::nearest_name(name, e.metrics);
    throw InputError(source, name,
                     "policies are not selected by this figure" +
                         (near.empty() ? std::string() : "; did you mean " + near + "?"));
  }
  return static_cast<std::size_t>(found - e.metrics.begin());
}

/// Known caves identical to this one, with two contestants or more: several if flown from several starts.
std::vector<std::size_t> this_very_cave(const Experience& e, const Values& v, const CaveFigures& cave,
                                        const std::string& mesh_hash) {
  const std::string figures = to_json(cave);
  const auto known = std::count(figures.begin(), figures.end(), ':');
  std::vector<std::size_t> same;
  for (std::size_t c = 0; c < v.caves; ++c) {
    const bool alike = known >= kTellingFigures && figures == to_json(e.caves[c].figures);
    if (!alike && (mesh_hash.empty() || mesh_hash != e.caves[c].hash)) continue;
    int flew = 0;
    for (std::size_t k = 0; k < v.contestants; ++k) flew += !std::isnan(v.at(k, c));
    if (flew >= 2) same.push_back(c);
  }
  return same;
}

/// Best first; leaves out contestants that cannot be predicted.
std::vector<Expected> ranking_of(const Values& v, const std::vector<double>& level,
                                 const std::vector<double>& weight, double sign) {
  std::vector<Expected> ranking;
  double sum = 0, squares = 0;
  for (const double w : weight) {
    sum += w;
    squares += w * w;
  }
  for (std::size_t k = 0; k < v.contestants; ++k) {
    const double value = predict(v, level, weight, k);
    if (!std::isnan(value)) ranking.push_back({k, value, kUnknown, kUnknown, sum * sum / squares});
  }
  std::stable_sort(ranking.begin(), ranking.end(),
                   [&](const Expected& a, const Expected& b) { return sign * a.value > sign * b.value; });
  return ranking;
}

/// The values that a metric can have in a cave.
struct PossibleRange {
  double least, most;
  double nearest_to(double value) const { return std::clamp(value, least, most); }  // NaN stays NaN
};

/// No flight maps more volume than the cave has.
PossibleRange possible_range(const std::string& metric, const CaveFigures& cave) {
  const evaluation::MetricDefinition& figure =
      evaluation::metric_definitions()[static_cast<std::size_t>(evaluation::metric_index(metric))];
  PossibleRange range{figure.least, figure.most};
  const bool is_volume = metric == "explored_volume_m3" || metric == "reachable_volume_m3";
  if (is_volume && !std::isnan(cave.volume_m3)) range.most = std::min(range.most, cave.volume_m3);
  return range;
}

/// No more volume is explored than the coverage times the volume of the cave.
void bound_volume(const std::vector<std::string>& metrics, const CaveFigures& cave,
                  std::vector<double>& figures) {
  const auto index = [&](const char* name) {
    return static_cast<std::size_t>(std::find(metrics.begin(), metrics.end(), name) - metrics.begin());
  };
  const std::size_t coverage = index("coverage"), volume = index("explored_volume_m3");
  if (coverage >= metrics.size() || volume >= metrics.size()) return;
  if (const double most_m3 = figures[coverage] * cave.volume_m3; figures[volume] > most_m3)
    figures[volume] = most_m3;
}

/// Student's interval from the errors in left-out caves: for the mean in a new cave.
void give_intervals(const Experience& e, const Values& v, const std::vector<double>& level,
                    const Kernel& kernel, double probability, std::vector<Expected>& ranking) {
  const std::vector<double> residuals = left_out_residuals(e, v, level, kernel, Predicted::value);
  for (Expected& x : ranking) {
    double squares = 0;
    int n = 0;
    for (std::size_t c = 0; c < v.caves; ++c)
      if (const double r = residuals[x.contestant * v.caves + c]; !std::isnan(r)) {
        squares += r * r;
        ++n;
      }
    if (n < static_cast<int>(kFewestCaves)) continue;
    const boost::math::students_t student(n - 1);
    const double half = boost::math::quantile(student, 0.5 + probability / 2) * std::sqrt(squares / n);
    x.low = x.value - half;
    x.high = x.value + half;
  }
}

/// Intervals of the mean over other seeds in flown caves; unknown if a cave has fewer than two seeds.
void give_intervals_there(const Experience& e, std::size_t metric, const std::vector<std::size_t>& there,
                          double probability, std::vector<Expected>& ranking) {
  const auto caves = static_cast<double>(there.size());
  for (Expected& x : ranking) {
    double variance = 0;
    int degrees = 0;
    for (const std::size_t c : there) {
      const Fared& f = e.at(x.contestant, c, metric);
      variance += f.deviation * f.deviation / f.flights / (caves * caves);
      degrees += f.flights - 1;
    }
    if (!std::isfinite(variance)) continue;
    const boost::math::students_t student(degrees);
    const double half = boost::math::quantile(student, 0.5 + probability / 2) * std::sqrt(variance);
    x.low = x.value - half;
    x.high = x.value + half;
  }
}

/// How often the first contestant would be first with other seeds (means drawn within their errors) and, if
/// `other_caves`, with other caves (drawn with replacement).
double confidence_of(const Values& v, const std::vector<double>& weight, double sign, std::size_t first,
                     bool other_caves) {
  core::Random random = core::Random::stream(1, "confidence");
  int same = 0;
  for (int i = 0; i < kResamples; ++i) {
    std::vector<double> drawn = weight;
    if (other_caves) std::fill(drawn.begin(), drawn.end(), 0.0);
    for (std::size_t c = 0; other_caves && c < v.caves; ++c) {
      const auto pick = static_cast<std::size_t>(random.uniform() * static_cast<double>(v.caves));
      drawn[pick] += weight[pick];
    }
    Values noisy = v;
    for (std::size_t j = 0; j < noisy.mean.size(); ++j) noisy.mean[j] += noisy.error[j] * random.normal();
    const std::vector<Expected> ranking = ranking_of(noisy, levels(noisy), drawn, sign);
    same += !ranking.empty() && ranking.front().contestant == first;
  }
  return static_cast<double>(same) / kResamples;
}

}  // namespace

Selected select(const Experience& e, const CaveFigures& cave, const SelectOptions& options,
                const std::string& source, const std::string& mesh_hash) {
  const std::string of = e.source.empty() ? source : e.source;
  const std::size_t metric = metric_of(e, options.metric, of);
  const double sign = evaluation::better_sign(options.metric, of);
  if (to_json(cave) == "{}") throw InputError(source, "", "nothing is known of the cave");
  const Values values = values_of(e, metric);
  const std::vector<double> level = levels(values), scales = robust_scales(e.caves);
  const auto known = static_cast<std::size_t>(
      std::count_if(level.begin(), level.end(), [](double l) { return !std::isnan(l); }));
  const std::vector<std::size_t> same = this_very_cave(e, values, cave, mesh_hash);
  if (same.empty() && known < kFewestCaves)
    throw InputError(of, options.metric,
                     "is known of " + core::counted(known, "cave") + "; " + std::to_string(kFewestCaves) +
                         " at least are needed to select a policy");

  Selected s;
  s.flown = !same.empty();
  s.bandwidth = best_bandwidth(e, values, level, scales);
  const Kernel kernel{scales, s.bandwidth};
  s.limit = farthest_neighbour(e.caves, scales);
  std::vector<double> weight = kernel_weights(e.caves, cave, kernel);
  if (s.flown) std::fill(weight.begin(), weight.end(), 0.0);
  for (const std::size_t c : same) weight[c] = 1;
  double all = 0;
  for (std::size_t c = 0; c < e.caves.size(); ++c) all += std::isnan(level[c]) ? 0 : weight[c];
  for (std::size_t c = 0; c < e.caves.size(); ++c)
    if (const Distance d = distance_between(cave, e.caves[c].figures, scales);
        !std::isnan(level[c]) && d.shared > 0)
      s.near.push_back({c, d, weight[c] / all});
  if (s.near.empty())
    throw InputError(of, "", "no cave that was flown has a figure that this one is described by");
  std::stable_sort(s.near.begin(), s.near.end(),
                   [](const NearCave& a, const NearCave& b) { return a.distance.value < b.distance.value; });
  s.ranking = ranking_of(values, level, weight, sign);
  if (s.ranking.empty())
    throw InputError(of, options.metric, "no policy flew in enough of the caves like this one");
  if (s.flown)
    give_intervals_there(e, metric, same, options.level, s.ranking);
  else
    give_intervals(e, values, level, kernel, options.level, s.ranking);
  const PossibleRange range = possible_range(options.metric, cave);
  for (Expected& x : s.ranking)
    for (double* value : {&x.value, &x.low, &x.high}) *value = range.nearest_to(*value);
  s.confidence = confidence_of(values, weight, sign, s.ranking.front().contestant, !s.flown);
  s.refused = !s.flown && s.near.front().distance.value > s.limit;
  s.reason = s.refused ? why_far(e, cave, s.near.front(), s.limit) : why_first(e, s, options);
  return s;
}

std::vector<double> expected_figures(const Experience& e, const CaveFigures& cave, const Selected& s,
                                     std::size_t contestant) {
  std::vector<double> weight(e.caves.size(), 0.0), out;
  for (const NearCave& n : s.near) weight[n.cave] = n.weight;
  for (std::size_t m = 0; m < e.metrics.size(); ++m) {
    const Values values = values_of(e, m);
    const double expected = predict(values, levels(values), weight, contestant);
    out.push_back(possible_range(e.metrics[m], cave).nearest_to(expected));
  }
  bound_volume(e.metrics, cave, out);
  return out;
}

}  // namespace karst::selection
