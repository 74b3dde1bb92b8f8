#include "sdk/selection/select.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/selection/prediction.h"
#include "sdk/selection/select_words.h"

namespace karst::selection {
namespace {

using core::InputError;

constexpr int kResamples = 1000;
constexpr double kMaxEnduranceRatio = 3;  // farther from all endurances flown nothing is named
constexpr double kMaxRatioThere = 2;      // the same of flights in this very cave
constexpr int kTellingFigures = 6;        // least number of known figures to identify a cave by equal figures

/// Whether enough figures are known of both, and all of them agree to six digits, as files hold them.
bool same_figures(const CaveFigures& a, const CaveFigures& b) {
  int known = 0;
  for (const FigureDefinition& f : figure_definitions()) {
    if (!std::isfinite(a.*f.value) || !std::isfinite(b.*f.value)) continue;
    ++known;
    if (core::format_text("%.6g", a.*f.value) != core::format_text("%.6g", b.*f.value)) return false;
  }
  return known >= kTellingFigures;
}

/// The sites of this very cave under the conditions asked for, of the nearest endurance, if two contestants
/// or more flew there: several if it was flown from several starts.
std::vector<std::size_t> this_very_cave(const Experience& e, const Values& v, const CaveFigures& cave,
                                        const AskedConditions& asked, const std::string& mesh_hash) {
  std::vector<std::size_t> same;
  double nearest = std::numeric_limits<double>::infinity();  // by endurance
  for (std::size_t s = 0; s < v.sites; ++s) {
    const KnownCave& there = e.caves[e.sites[s].cave];
    if (!same_figures(cave, there.figures) && (mesh_hash.empty() || mesh_hash != there.hash)) continue;
    const Condition& condition = e.conditions[e.sites[s].condition];
    AskedConditions but_time = asked;
    but_time.endurance_s = kUnknown;
    if (!meets(condition, but_time)) continue;
    int flew = 0;
    for (std::size_t k = 0; k < v.contestants; ++k) flew += !std::isnan(v.at(k, s));
    if (flew < 2) continue;
    const double off =
        std::isnan(asked.endurance_s) ? 0 : std::abs(std::log(condition.endurance_s / asked.endurance_s));
    if (off > std::log(kMaxRatioThere) || off > nearest + 1e-9) continue;
    if (off < nearest - 1e-9) same.clear();
    nearest = off;
    same.push_back(s);
  }
  return same;
}

std::vector<Expected> ranking_of(const Values& v, const std::vector<double>& level,
                                 const SiteWeights& weights, double sign) {
  std::vector<Expected> ranking;
  double sum = 0, squares = 0;
  for (const double w : weights.advantage) {
    sum += w;
    squares += w * w;
  }
  for (std::size_t k = 0; k < v.contestants; ++k) {
    const double value = predict(v, level, weights, k);
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

/// No flight maps more volume than the cave has, or gets farther from the start than its passages are long.
PossibleRange possible_range(const std::string& metric, const CaveFigures& cave) {
  const evaluation::MetricDefinition& figure =
      evaluation::metric_definitions()[static_cast<std::size_t>(evaluation::metric_index(metric))];
  PossibleRange range{figure.least, figure.most};
  const bool is_volume = metric == "explored_volume_m3" || metric == "reachable_volume_m3";
  if (is_volume && !std::isnan(cave.volume_m3)) range.most = std::min(range.most, cave.volume_m3);
  if (metric == "depth_m" && !std::isnan(cave.length_m)) range.most = std::min(range.most, cave.length_m);
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

/// Student's interval from the errors in left-out caves: for the mean in a new cave. Errors under conditions
/// like those asked for count most.
void give_intervals(const Experience& e, const Values& v, const std::vector<double>& level,
                    const Kernel& kernel, const SelectOptions& options, std::vector<Expected>& ranking) {
  const std::vector<double> residuals = left_out_residuals(e, v, level, kernel),
                            weights = level_weights(e.conditions, options.conditions);
  const std::vector<std::size_t> rock = rocks_of(e);
  for (Expected& x : ranking) {
    double squares = 0, sum = 0;
    std::vector<double> of_rock(e.caves.size(), 0.0);
    for (std::size_t s = 0; s < v.sites; ++s)
      if (const double r = residuals[x.contestant * v.sites + s]; !std::isnan(r)) {
        const double w = weights[e.sites[s].condition];
        squares += w * r * r;
        sum += w;
        of_rock[rock[e.sites[s].cave]] += w;
      }
    // How many caves of equal weight say as much (Kish's effective sample size).
    double weight_squares = 0;
    for (const double w : of_rock) weight_squares += w * w;
    const double n = sum * sum / weight_squares;
    if (!(n > static_cast<double>(kFewestCaves) - 0.5)) continue;
    const boost::math::students_t student(n - 1);
    const double half = boost::math::quantile(student, 0.5 + options.level / 2) * std::sqrt(squares / sum);
    x.low = x.value - half;
    x.high = x.value + half;
  }
}

/// Intervals of the mean over other seeds at flown sites; unknown if a site has fewer than two seeds.
void give_intervals_there(const Experience& e, std::size_t metric, const std::vector<std::size_t>& there,
                          double probability, std::vector<Expected>& ranking) {
  const auto sites = static_cast<double>(there.size());
  for (Expected& x : ranking) {
    double variance = 0;
    double degrees = 0;
    for (const std::size_t s : there) {
      const Fared& f = e.at(x.contestant, s, metric);
      variance += f.deviation * f.deviation / f.flights / (sites * sites);
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
double confidence_of(const Experience& e, const Values& v, const SiteWeights& weights, double sign,
                     std::size_t first, bool other_caves) {
  core::Random random = core::Random::stream(1, "confidence");
  const std::vector<std::size_t> rock = rocks_of(e);
  const std::set<std::size_t> distinct(rock.begin(), rock.end());
  const std::vector<std::size_t> rocks(distinct.begin(), distinct.end());
  int same = 0;
  for (int i = 0; i < kResamples; ++i) {
    std::vector<double> times(e.caves.size(), other_caves ? 0.0 : 1.0);
    for (std::size_t c = 0; other_caves && c < rocks.size(); ++c)
      times[rocks[static_cast<std::size_t>(random.uniform() * static_cast<double>(rocks.size()))]] += 1;
    SiteWeights drawn = weights;
    for (std::size_t s = 0; s < v.sites; ++s) {
      drawn.advantage[s] *= times[rock[e.sites[s].cave]];
      drawn.level[s] *= times[rock[e.sites[s].cave]];
    }
    Values noisy = v;
    for (std::size_t j = 0; j < noisy.mean.size(); ++j) noisy.mean[j] += noisy.error[j] * random.normal();
    const std::vector<Expected> ranking = ranking_of(noisy, levels(noisy), drawn, sign);
    same += !ranking.empty() && ranking.front().contestant == first;
  }
  return static_cast<double>(same) / kResamples;
}

Evidence evidence_of(const Experience& e, std::size_t metric, const AskedConditions& asked) {
  Evidence out;
  std::vector<bool> caves(e.caves.size()), as_asked(e.caves.size());
  for (std::size_t s = 0; s < e.sites.size(); ++s) {
    const bool meets_it = meets(e.conditions[e.sites[s].condition], asked);
    for (std::size_t k = 0; k < e.contestants.size(); ++k) {
      const auto n = static_cast<std::size_t>(e.at(k, s, metric).flights);
      if (n == 0) continue;
      out.flights += n;
      caves[e.sites[s].cave] = true;
      if (!meets_it) continue;
      out.flights_as_asked += n;
      as_asked[e.sites[s].cave] = true;
    }
  }
  out.caves = static_cast<std::size_t>(std::count(caves.begin(), caves.end(), true));
  out.caves_as_asked = static_cast<std::size_t>(std::count(as_asked.begin(), as_asked.end(), true));
  return out;
}

/// Distances of all caves in which the metric is known, nearest first.
std::vector<NearCave> near_caves(const Experience& e, const std::vector<double>& level,
                                 const CaveFigures& cave, const std::vector<double>& scales,
                                 const std::vector<double>& weight) {
  std::vector<double> of_cave(e.caves.size(), 0.0);
  std::vector<bool> known(e.caves.size(), false);
  double all = 0;
  for (std::size_t s = 0; s < e.sites.size(); ++s)
    if (!std::isnan(level[s])) {
      known[e.sites[s].cave] = true;
      of_cave[e.sites[s].cave] += weight[s];
      all += weight[s];
    }
  std::vector<NearCave> near;
  for (std::size_t c = 0; c < e.caves.size(); ++c)
    if (const Distance d = distance_between(cave, e.caves[c].figures, scales); known[c] && d.shared > 0)
      near.push_back({c, d, of_cave[c] / all});
  std::stable_sort(near.begin(), near.end(),
                   [](const NearCave& a, const NearCave& b) { return a.distance.value < b.distance.value; });
  return near;
}

}  // namespace

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

Fit fit(const Experience& e, std::size_t metric) {
  const Values values = values_of(e, metric);
  return fit(e, values, levels(values));
}

std::vector<Expected> ranking_by(const Experience& e, std::size_t metric, const SiteWeights& weights) {
  const Values values = values_of(e, metric);
  return ranking_of(values, levels(values), weights, evaluation::better_sign(e.metrics[metric], e.source));
}

std::string why_other_conditions(const Experience& e, const AskedConditions& a) {
  std::set<std::string> vehicles;
  double shortest_s = std::numeric_limits<double>::infinity(), longest_s = 0;
  bool team = false, alone = false, unnamed = false;
  for (const Condition& c : e.conditions) {
    unnamed |= c.vehicle.empty();
    vehicles.insert(c.vehicle);
    shortest_s = std::min(shortest_s, c.endurance_s);
    longest_s = std::max(longest_s, c.endurance_s);
    (c.robots > 1 ? team : alone) = true;
  }
  if (!a.vehicle.empty() && !unnamed && !vehicles.contains(a.vehicle)) {
    std::string known;
    for (const std::string& v : vehicles) known += (known.empty() ? "" : ", ") + v;
    return "no flight of the vehicle " + a.vehicle + " is known; those of " + known + " are";
  }
  if (a.endurance_s > kMaxEnduranceRatio * longest_s || a.endurance_s < shortest_s / kMaxEnduranceRatio)
    return core::format_text("no flight of nearly %.0f s is known; those known last at most %.0f to %.0f s",
                             a.endurance_s, shortest_s, longest_s);
  if (a.robots > 1 && !team) return "no flight of a team is known";
  if (a.robots == 1 && !alone) return "no flight of a single vehicle is known";
  return "";
}

Selected select(const Experience& e, const CaveFigures& cave, const SelectOptions& options,
                const std::string& source, const std::string& mesh_hash) {
  const std::string of = e.source.empty() ? source : e.source;
  const std::size_t metric = metric_of(e, options.metric, of);
  const double sign = evaluation::better_sign(options.metric, of);
  if (to_json(cave) == "{}") throw InputError(source, "", "nothing is known of the cave");
  const Values values = values_of(e, metric);
  const std::vector<double> level = levels(values), scales = robust_scales(e.caves);
  const std::vector<std::size_t> same = this_very_cave(e, values, cave, options.conditions, mesh_hash);
  Selected s;
  s.evidence = evidence_of(e, metric, options.conditions);
  if (same.empty() && s.evidence.caves < kFewestCaves)
    throw InputError(of, options.metric,
                     "is known of " + core::counted(s.evidence.caves, "cave") + "; " +
                         std::to_string(kFewestCaves) + " at least are needed to select a policy");

  s.flown = !same.empty();
  if (!s.flown) s.fit = fit(e, values, level);
  if (s.flown) {
    s.weights.advantage.assign(e.sites.size(), 0.0);
    for (const std::size_t site : same) s.weights.advantage[site] = 1;
    s.weights.level = s.weights.advantage;
  } else {
    s.weights = site_weights(e, cave, options.conditions, s.fit.kernel);
  }
  s.limit = farthest_neighbour(e.caves, scales);
  s.near = near_caves(e, level, cave, scales, s.weights.advantage);
  if (s.near.empty())
    throw InputError(of, "", "no cave that was flown has a figure that this one is described by");
  if (const std::string other = why_other_conditions(e, options.conditions); !s.flown && !other.empty()) {
    s.refused = true;
    s.reason = other;
    return s;
  }
  s.ranking = ranking_of(values, level, s.weights, sign);
  if (s.ranking.empty())
    throw InputError(of, options.metric, "no policy flew in enough of the caves like this one");
  if (s.flown)
    give_intervals_there(e, metric, same, options.level, s.ranking);
  else
    give_intervals(e, values, level, s.fit.kernel, options, s.ranking);
  const PossibleRange range = possible_range(options.metric, cave);
  for (Expected& x : s.ranking)
    for (double* value : {&x.value, &x.low, &x.high}) *value = range.nearest_to(*value);
  s.confidence = confidence_of(e, values, s.weights, sign, s.ranking.front().contestant, !s.flown);
  s.refused = !s.flown && s.near.front().distance.value > s.limit;
  s.reason = s.refused ? why_far(e, cave, s.near.front(), s.limit) : why_first(e, s, options);
  return s;
}

std::vector<double> expected_figures(const Experience& e, const CaveFigures& cave, const Selected& s,
                                     std::size_t contestant) {
  std::vector<double> out;
  for (std::size_t m = 0; m < e.metrics.size(); ++m) {
    const Values values = values_of(e, m);
    const double expected = predict(values, levels(values), s.weights, contestant);
    out.push_back(possible_range(e.metrics[m], cave).nearest_to(expected));
  }
  bound_volume(e.metrics, cave, out);
  return out;
}

}  // namespace karst::selection
