#include "sdk/selection/select.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "sdk/evaluation/metric_definitions.h"

namespace karst::selection {
namespace {

using core::InputError;

constexpr double kMostAlike = 1.5;       // times the weight each cave would have if all had the same
constexpr std::size_t kFewestCaves = 4;  // fewer say nothing of how far an experience carries
constexpr double kLeastShare = 0.25;     // of the weight that a contestant must have flown in
constexpr double kNear = 0.7;            // units: less than caves drawn at random differ by
constexpr int kResamples = 1000;
const std::array kBandwidths{0.5, 0.7, 1.0, 1.4, 2.0, 3.0, std::numeric_limits<double>::infinity()};

/// One metric: a value a contestant and cave, NaN where nothing flew.
struct Values {
  std::size_t contestants, caves;
  std::vector<double> mean, error;  // error of the mean, as far as it is known
  double at(std::size_t k, std::size_t c) const { return mean[k * caves + c]; }
};

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

/// What a cave lets one expect of any contestant: the mean over those that flew in every cave, so that it
/// means the same everywhere, or over all that flew there if none did.
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
      if (const double x = v.at(k, c); !std::isnan(x) && (everywhere[k] || !some)) sum += x, ++n;
    if (n > 0) level[c] = sum / n;
  }
  return level;
}

/// The weighted level, and on it the weighted advantage over the level where the contestant flew (Nadaraya,
/// Watson, 1964). NaN of a contestant that flew in too little of the weight.
double predict(const Values& v, const std::vector<double>& level, const std::vector<double>& weight,
               std::size_t k) {
  double all = 0, levels = 0, flown = 0, advantages = 0;
  for (std::size_t c = 0; c < v.caves; ++c) {
    if (std::isnan(level[c])) continue;
    all += weight[c], levels += weight[c] * level[c];
    if (const double x = v.at(k, c); !std::isnan(x))
      flown += weight[c], advantages += weight[c] * (x - level[c]);
  }
  return all > 0 && flown >= kLeastShare * all ? levels / all + advantages / flown : kUnknown;
}

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

/// Figures that are not known count as no difference here: the fewer are known, the less the weights differ.
std::vector<double> kernel_weights(const std::vector<KnownCave>& caves, const CaveFigures& cave,
                                   const std::vector<double>& scales, double bandwidth) {
  std::vector<double> squared, weight;
  for (const KnownCave& known : caves) {
    const Distance d = distance_between(cave, known.figures, scales);
    squared.push_back(d.shared == 0
                          ? std::numeric_limits<double>::infinity()
                          : d.value * d.value * shared_weight(cave, known.figures) / total_weight());
  }
  // Relative to the nearest: far from everything, the weights would all vanish.
  const double least = *std::min_element(squared.begin(), squared.end());
  for (const double s : squared)
    weight.push_back(std::isinf(s) ? 0.0 : std::exp(-0.5 * (s - least) / (bandwidth * bandwidth)));
  return weight;
}

/// Residuals of predicting each cave from the others, by contestant and cave; NaN where there is none.
std::vector<double> left_out_residuals(const Experience& e, const Values& v, const std::vector<double>& level,
                                       const std::vector<double>& scales, double bandwidth,
                                       bool of_advantage) {
  std::vector<double> residuals(v.mean.size(), kUnknown);
  for (std::size_t c = 0; c < v.caves; ++c) {
    if (std::isnan(level[c])) continue;
    std::vector<KnownCave> others = e.caves;
    others[c].figures = {};  // of which nothing is known weighs nothing
    const std::vector<double> weight = kernel_weights(others, e.caves[c].figures, scales, bandwidth);
    double expected_level = 0, all = 0;
    for (std::size_t o = 0; o < v.caves; ++o)
      if (!std::isnan(level[o])) all += weight[o], expected_level += weight[o] * level[o];
    for (std::size_t k = 0; k < v.contestants; ++k)
      if (!std::isnan(v.at(k, c)))
        residuals[k * v.caves + c] = v.at(k, c) - predict(v, level, weight, k) -
                                     (of_advantage ? level[c] - expected_level / all : 0.0);
  }
  return residuals;
}

/// The bandwidth at which caves left out are predicted best, in what tells contestants apart, as a share of
/// the cave's level. Infinity stands for caves that tell nothing.
double best_bandwidth(const Experience& e, const Values& v, const std::vector<double>& level,
                      const std::vector<double>& scales) {
  double best = kBandwidths.back(), least = std::numeric_limits<double>::infinity();
  for (auto h = kBandwidths.rbegin(); h != kBandwidths.rend(); ++h) {
    const std::vector<double> residuals = left_out_residuals(e, v, level, scales, *h, true);
    double sum = 0;
    int n = 0;
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const double l = level[i % v.caves];
      if (std::isnan(residuals[i]) || l == 0) continue;
      sum += residuals[i] * residuals[i] / (l * l), ++n;
    }
    if (n > 0 && sum / n < least * (1 - 1e-9)) least = sum / n, best = *h;
  }
  return best;
}

double sign_of(const std::string& metric, const std::string& source) {
  const int i = evaluation::metric_index(metric);
  if (i < 0) throw InputError(source, metric, "no such figure");
  const evaluation::Better better = evaluation::metric_definitions()[static_cast<std::size_t>(i)].better;
  if (better == evaluation::Better::neither)
    throw InputError(source, metric, "more of it is neither better nor worse: nothing to select by");
  return better == evaluation::Better::more ? 1 : -1;
}

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

/// The best first; those that cannot be predicted are left out.
std::vector<Expected> ranking_of(const Values& v, const std::vector<double>& level,
                                 const std::vector<double>& weight, double sign) {
  std::vector<Expected> ranking;
  double sum = 0, squares = 0;
  for (const double w : weight) sum += w, squares += w * w;
  for (std::size_t k = 0; k < v.contestants; ++k) {
    const double value = predict(v, level, weight, k);
    if (!std::isnan(value)) ranking.push_back({k, value, kUnknown, kUnknown, sum * sum / squares});
  }
  std::stable_sort(ranking.begin(), ranking.end(),
                   [&](const Expected& a, const Expected& b) { return sign * a.value > sign * b.value; });
  return ranking;
}

/// Student's interval of the errors made in caves left out: of the mean in a new cave.
void give_intervals(const Experience& e, const Values& v, const std::vector<double>& level,
                    const std::vector<double>& scales, double bandwidth, double probability,
                    std::vector<Expected>& ranking) {
  const std::vector<double> residuals = left_out_residuals(e, v, level, scales, bandwidth, false);
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double x : v.mean)
    if (!std::isnan(x)) least = std::min(least, x), most = std::max(most, x);
  for (Expected& x : ranking) {
    double squares = 0;
    int n = 0;
    for (std::size_t c = 0; c < v.caves; ++c)
      if (const double r = residuals[x.contestant * v.caves + c]; !std::isnan(r)) squares += r * r, ++n;
    if (n < static_cast<int>(kFewestCaves)) continue;
    const boost::math::students_t student(n - 1);
    const double half = boost::math::quantile(student, 0.5 + probability / 2) * std::sqrt(squares / n);
    x.low = x.value - half, x.high = x.value + half;
    if (least >= 0) x.low = std::max(0.0, x.low);
    if (least >= 0 && most <= 1) x.high = std::min(1.0, x.high);
  }
}

/// How often the first one would have been first with other caves and other seeds: caves drawn with
/// replacement, and means within their errors.
double confidence_of(const Values& v, const std::vector<double>& weight, double sign, std::size_t first) {
  core::Random random = core::Random::stream(1, "confidence");
  int same = 0;
  for (int i = 0; i < kResamples; ++i) {
    std::vector<double> drawn(v.caves, 0.0);
    for (std::size_t c = 0; c < v.caves; ++c) {
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

/// The largest distance at which a cave's nearest other one lies: leaving caves out shows nothing of larger
/// ones.
double limit_of(const std::vector<KnownCave>& caves, const std::vector<double>& scales) {
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

std::string text(const char* format, auto... values) {
  std::array<char, 400> buffer;
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

/// What is farthest off, in words: the figure here, and its range in the caves flown.
std::string why_far(const Experience& e, const CaveFigures& cave, const NearCave& nearest, double limit) {
  const FigureDefinition& f = figure_definitions()[static_cast<std::size_t>(nearest.distance.farthest)];
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const KnownCave& k : e.caves)
    if (const double x = k.figures.*f.value; std::isfinite(x))
      low = std::min(low, x), high = std::max(high, x);
  const std::string unit = f.unit.empty() ? "" : " " + std::string(f.unit);
  return text(
      "nothing like this cave was flown: the nearest, %s, is at distance %.2f, and caves farther than %.2f "
      "from all "
      "others were never tried; most unlike is its %s: %.3g%s, against %.3g%s there and %.3g to %.3g%s in "
      "all",
      e.caves[nearest.cave].name.c_str(), nearest.distance.value, limit, std::string(f.name).c_str(),
      cave.*f.value, unit.c_str(), e.caves[nearest.cave].figures.*f.value, unit.c_str(), low, high,
      unit.c_str());
}

std::string why_first(const Experience& e, const Selected& s, const SelectOptions& options) {
  const Expected& first = s.ranking.front();
  std::string out = text("%s is expected to do best in %s (%.3g",
                         e.contestants[first.contestant].name.c_str(), options.metric.c_str(), first.value);
  if (!std::isnan(first.low))
    out += text(", %.0f %% interval %.3g to %.3g", 100 * options.level, first.low, first.high);
  // A wide bandwidth weighs all nearly alike: that the nearest are like this cave then decides nothing.
  const bool alike = s.near.front().weight < kMostAlike / static_cast<double>(e.caves.size());
  out += std::isinf(s.bandwidth) || alike
             ? ") by all caves flown alike, for what these are like did not foretell which policy is best; "
               "nearest: "
             : ") by caves like this one: ";
  for (std::size_t i = 0; i < s.near.size() && i < 3; ++i)
    out += text("%s%s (distance %.2f, weight %.0f %%)", i ? ", " : "", e.caves[s.near[i].cave].name.c_str(),
                s.near[i].distance.value, 100 * s.near[i].weight);
  return out + text("; confidence %.0f %%", 100 * s.confidence);
}

}  // namespace

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
    double scale = f.least_scale;
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
    sum += square, weights += f.weight, ++d.shared;
    if (square > largest) largest = square, d.farthest = static_cast<int>(i);
  }
  if (d.shared > 0) d.value = std::sqrt(sum / weights);
  return d;
}

Selected select(const Experience& e, const CaveFigures& cave, const SelectOptions& options,
                const std::string& source) {
  const std::size_t metric = metric_of(e, options.metric, source);
  const double sign = sign_of(options.metric, source);
  if (to_json(cave) == "{}") throw InputError(source, "", "nothing is known of the cave");
  const Values values = values_of(e, metric);
  const std::vector<double> level = levels(values), scales = robust_scales(e.caves);
  const auto known = static_cast<std::size_t>(
      std::count_if(level.begin(), level.end(), [](double l) { return !std::isnan(l); }));
  if (known < kFewestCaves)
    throw InputError(
        source, options.metric,
        text("is known of %zu caves; %zu at least are needed to select a policy", known, kFewestCaves));

  Selected s;
  s.bandwidth = best_bandwidth(e, values, level, scales);
  s.limit = limit_of(e.caves, scales);
  const std::vector<double> weight = kernel_weights(e.caves, cave, scales, s.bandwidth);
  double all = 0;
  for (std::size_t c = 0; c < e.caves.size(); ++c) all += std::isnan(level[c]) ? 0 : weight[c];
  for (std::size_t c = 0; c < e.caves.size(); ++c)
    if (const Distance d = distance_between(cave, e.caves[c].figures, scales);
        !std::isnan(level[c]) && d.shared > 0)
      s.near.push_back({c, d, weight[c] / all});
  if (s.near.empty())
    throw InputError(source, "", "no cave that was flown has a figure that this one is described by");
  std::stable_sort(s.near.begin(), s.near.end(),
                   [](const NearCave& a, const NearCave& b) { return a.distance.value < b.distance.value; });
  s.ranking = ranking_of(values, level, weight, sign);
  if (s.ranking.empty())
    throw InputError(source, options.metric, "no policy flew in enough of the caves like this one");
  give_intervals(e, values, level, scales, s.bandwidth, options.level, s.ranking);
  s.confidence = confidence_of(values, weight, sign, s.ranking.front().contestant);
  s.refused = s.near.front().distance.value > s.limit;
  s.reason = s.refused ? why_far(e, cave, s.near.front(), s.limit) : why_first(e, s, options);
  return s;
}

std::vector<double> expected_figures(const Experience& e, const Selected& s, std::size_t contestant) {
  std::vector<double> weight(e.caves.size(), 0.0), out;
  for (const NearCave& n : s.near) weight[n.cave] = n.weight;
  for (std::size_t m = 0; m < e.metrics.size(); ++m) {
    const Values values = values_of(e, m);
    out.push_back(predict(values, levels(values), weight, contestant));
  }
  return out;
}

}  // namespace karst::selection
