#include "sdk/selection/leave_one_out.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/random.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/selection/goal.h"

namespace karst::selection {
namespace {

constexpr double kLevel = 0.95;
constexpr int kDraws = 2000;
constexpr double kMinShareOfCells = 0.5;  // in which a contestant must have flown to be the best on average

bool flew(const Experience& e, std::size_t k, std::size_t s, std::size_t m) {
  return e.at(k, s, m).flights > 0;
}

/// How near a value comes to the best one: 1 if it is as good, 0 if it is nothing beside it.
double score(double value, double best, double sign) {
  if (value == best) return 1;
  const double ratio = sign > 0 ? value / best : best / value;
  return std::isfinite(ratio) ? std::clamp(ratio, 0.0, 1.0) : 0.0;
}

/// The contestants that flew at a site, and the best of them.
struct Field {
  std::vector<std::size_t> flew;
  std::size_t best = 0;
};
Field field_at(const Experience& e, std::size_t s, std::size_t m, double sign) {
  Field f;
  for (std::size_t k = 0; k < e.contestants.size(); ++k)
    if (flew(e, k, s, m)) f.flew.push_back(k);
  if (!f.flew.empty())
    f.best = *std::min_element(f.flew.begin(), f.flew.end(), [&](std::size_t a, std::size_t b) {
      return sign * e.at(a, s, m).mean > sign * e.at(b, s, m).mean;
    });
  return f;
}

double sign_of(const Experience& e, std::size_t m) { return evaluation::better_sign(e.metrics[m], e.source); }

struct MeanScore {
  std::size_t contestant;
  double mean;
};

/// Contestants by their mean score over these goals and the sites that `counts`, the best first.
std::vector<MeanScore> mean_scores(const Experience& e, const std::vector<std::size_t>& metrics,
                                   const std::function<bool(std::size_t site)>& counts) {
  std::vector<double> sum(e.contestants.size(), 0.0), n(e.contestants.size(), 0.0);
  double cells = 0;
  for (const std::size_t m : metrics)
    for (std::size_t s = 0; s < e.sites.size(); ++s) {
      if (!counts(s)) continue;
      const Field f = field_at(e, s, m, sign_of(e, m));
      if (f.flew.size() < 2) continue;
      cells += 1;
      for (const std::size_t k : f.flew) {
        sum[k] += score(e.at(k, s, m).mean, e.at(f.best, s, m).mean, sign_of(e, m));
        n[k] += 1;
      }
    }
  std::vector<MeanScore> order;
  for (std::size_t k = 0; k < sum.size(); ++k)
    if (n[k] > 0 && n[k] >= kMinShareOfCells * cells) order.push_back({k, sum[k] / n[k]});
  std::stable_sort(order.begin(), order.end(),
                   [](const MeanScore& x, const MeanScore& y) { return x.mean > y.mean; });
  return order;
}

std::vector<std::size_t> best_first(const Experience& e, const std::vector<std::size_t>& metrics,
                                    const std::function<bool(std::size_t site)>& counts) {
  std::vector<std::size_t> order;
  for (const MeanScore& x : mean_scores(e, metrics, counts)) order.push_back(x.contestant);
  return order;
}

std::vector<std::size_t> order_of(const std::vector<Expected>& ranking) {
  std::vector<std::size_t> order;
  for (const Expected& x : ranking) order.push_back(x.contestant);
  return order;
}

/// The experience without the rock of a cave: other starts in it are the same cave.
Experience without_rock(const Experience& e, std::size_t cave) {
  Experience rest = e;
  for (std::size_t c = e.caves.size(); c-- > 0;)
    if (same_rock(e.caves[c], e.caves[cave])) rest = without_cave(rest, c);
  return rest;
}

Share share_of(const std::vector<double>& of_caves) {
  Share s;
  double sum = 0, squares = 0;
  for (const double x : of_caves) {
    sum += x;
    squares += x * x;
  }
  const auto n = static_cast<double>(of_caves.size());
  if (n < 1) return s;
  s.mean = sum / n;
  if (n < 2) return s;
  const double variance = std::max(0.0, (squares - sum * s.mean) / (n - 1));
  const double half =
      boost::math::quantile(boost::math::students_t(n - 1), 0.5 + kLevel / 2) * std::sqrt(variance / n);
  s.low = std::max(0.0, s.mean - half);
  s.high = std::min(1.0, s.mean + half);
  return s;
}

/// The means of each cave's choices.
std::vector<double> by_cave(const Experience& e, const std::vector<LeftOut>& choices,
                            const std::function<double(const LeftOut&)>& value) {
  std::map<std::size_t, std::pair<double, int>> sums;
  for (const LeftOut& l : choices) {
    auto& [sum, n] = sums[e.sites[l.site].cave];
    sum += value(l);
    ++n;
  }
  std::vector<double> means;
  for (const auto& [cave, sum] : sums) means.push_back(sum.first / sum.second);
  return means;
}

/// The ratio of two sums over caves, with an interval from caves drawn with replacement.
Share ratio_of(const std::vector<double>& above, const std::vector<double>& below) {
  const auto ratio = [&](const std::vector<std::size_t>& drawn) {
    double a = 0, b = 0;
    for (const std::size_t c : drawn) {
      a += above[c];
      b += below[c];
    }
    return b > 0 ? a / b : a > 0 ? std::numeric_limits<double>::infinity() : 1.0;
  };
  std::vector<std::size_t> drawn(above.size());
  for (std::size_t c = 0; c < drawn.size(); ++c) drawn[c] = c;
  Share s{ratio(drawn)};
  core::Random random = core::Random::stream(1, "leave one out");
  std::vector<double> ratios;
  for (int i = 0; i < kDraws; ++i) {
    for (std::size_t& c : drawn)
      c = static_cast<std::size_t>(random.uniform() * static_cast<double>(above.size()));
    ratios.push_back(ratio(drawn));
  }
  std::sort(ratios.begin(), ratios.end());
  s.low = ratios[static_cast<std::size_t>((1 - kLevel) / 2 * kDraws)];
  s.high = ratios[static_cast<std::size_t>((1 + kLevel) / 2 * kDraws) - 1];
  return s;
}

/// The choices of all rules for the sites of one cave.
class LeftOutCave {
 public:
  LeftOutCave(const Experience& e, const std::vector<std::size_t>& metrics, std::size_t cave)
      : e_(e), cave_(cave), rest_(without_rock(e, cave)) {
    const std::vector<double> scales = robust_scales(rest_.caves);
    limit_ = farthest_neighbour(rest_.caves, scales);
    nearest_ = std::numeric_limits<double>::infinity();
    for (const KnownCave& known : rest_.caves)
      if (const Distance d = distance_between(e.caves[cave].figures, known.figures, scales); d.shared > 0)
        nearest_ = std::min(nearest_, d.value);
    overall_ = best_first(rest_, metrics, [](std::size_t) { return true; });
    for (const std::size_t m : metrics) {
      fits_.emplace(m, fit(rest_, m));
      by_goal_.emplace(m, best_first(rest_, {m}, [](std::size_t) { return true; }));
    }
    for (const Condition& c : e.conditions)
      if (!by_vehicle_.contains(c.vehicle))
        by_vehicle_.emplace(c.vehicle, best_first(rest_, metrics, [&](std::size_t s) {
                              return rest_.conditions[rest_.sites[s].condition].vehicle == c.vehicle;
                            }));
  }

  /// Nothing if fewer than two contestants flew.
  std::optional<LeftOut> choice(std::size_t site, std::size_t metric) const {
    const double sign = sign_of(e_, metric);
    const Field field = field_at(e_, site, metric, sign);
    if (field.flew.size() < 2) return std::nullopt;
    const Condition& condition = e_.conditions[e_.sites[site].condition];
    LeftOut l{site, metric, field.best, e_.at(field.best, site, metric).mean, {}, false, nearest_};
    l.refused = nearest_ > limit_ || !why_other_conditions(rest_, asked(condition)).empty();
    Kernel kernel = fits_.at(metric).kernel;
    const auto ranked = [&](const Kernel& k) {
      return order_of(
          ranking_by(rest_, metric, site_weights(rest_, e_.caves[cave_].figures, asked(condition), k)));
    };
    const auto take = [&](Rule rule, const std::vector<std::size_t>& order) {
      std::size_t k = field.flew.front();
      for (auto it = order.rbegin(); it != order.rend(); ++it)
        if (flew(e_, *it, site, metric)) k = *it;
      l.by[static_cast<std::size_t>(rule)] = judged(site, metric, k, l.best_value, sign);
    };
    take(Rule::selected, ranked(kernel));
    kernel.bandwidth = std::numeric_limits<double>::infinity();
    take(Rule::conditions, ranked(kernel));
    take(Rule::overall, overall_);
    take(Rule::goal, by_goal_.at(metric));
    take(Rule::vehicle, by_vehicle_.at(condition.vehicle));
    Chosen chance{0, 0, 0, 0, 0};
    for (const std::size_t k : field.flew) {
      const Chosen c = judged(site, metric, k, l.best_value, sign);
      const auto n = static_cast<double>(field.flew.size());
      chance.value += c.value / n;
      chance.best += c.best / n;
      chance.within += c.within / n;
      chance.lost += c.lost / n;
    }
    l.by[static_cast<std::size_t>(Rule::chance)] = chance;
    return l;
  }

 private:
  Chosen judged(std::size_t site, std::size_t metric, std::size_t k, double best, double sign) const {
    const double value = e_.at(k, site, metric).mean, lost = 1 - score(value, best, sign);
    return {k, value, value == best ? 1.0 : 0.0, lost <= kAsGood + 1e-12 ? 1.0 : 0.0, lost};
  }

  const Experience& e_;
  std::size_t cave_;
  Experience rest_;
  double limit_ = 0, nearest_ = 0;
  std::vector<std::size_t> overall_;
  std::map<std::size_t, Fit> fits_;
  std::map<std::size_t, std::vector<std::size_t>> by_goal_;
  std::map<std::string, std::vector<std::size_t>> by_vehicle_;
};

/// In how many caves the figure is known; other starts in one mesh are the same cave.
std::size_t caves_with(const Experience& e, std::size_t m) {
  const std::vector<std::size_t> rock = rocks_of(e);
  std::vector<bool> known(e.caves.size(), false);
  for (std::size_t s = 0; s < e.sites.size(); ++s)
    for (std::size_t k = 0; k < e.contestants.size(); ++k)
      if (flew(e, k, s, m)) known[rock[e.sites[s].cave]] = true;
  return static_cast<std::size_t>(std::count(known.begin(), known.end(), true));
}

}  // namespace

std::optional<BestOnAverage> best_on_average(const Experience& e, std::size_t metric,
                                             const AskedConditions& asked) {
  const auto has_flown = [&](const Condition& c) { return c.vehicle == asked.vehicle; };
  const bool known = std::any_of(e.conditions.begin(), e.conditions.end(), has_flown);
  const auto counts = [&](std::size_t s) { return !known || has_flown(e.conditions[e.sites[s].condition]); };
  const std::vector<MeanScore> order = mean_scores(e, {metric}, counts);
  if (order.size() < 2 || order.front().mean == order.back().mean) return std::nullopt;
  const std::vector<std::size_t> rock = rocks_of(e);
  std::set<std::size_t> caves;
  for (std::size_t s = 0; s < e.sites.size(); ++s)
    if (counts(s) && field_at(e, s, metric, sign_of(e, metric)).flew.size() > 1)
      caves.insert(rock[e.sites[s].cave]);
  return BestOnAverage{order.front().contestant, caves.size(), known ? asked.vehicle : ""};
}

std::vector<std::string> goals_flown(const Experience& e) {
  std::vector<std::string> out;
  for (const Goal& g : goals()) {
    const auto found = std::find(e.metrics.begin(), e.metrics.end(), g.metric);
    if (found == e.metrics.end()) continue;
    const auto m = static_cast<std::size_t>(found - e.metrics.begin());
    bool some = false;
    for (std::size_t s = 0; s < e.sites.size(); ++s)
      for (std::size_t k = 0; k < e.contestants.size(); ++k) some |= e.at(k, s, m).mean > 0;
    if (some && caves_with(e, m) > kFewestCaves) out.emplace_back(g.metric);
  }
  return out;
}

std::array<RuleValue, kRules> value_of(const Experience& e, const std::vector<LeftOut>& choices) {
  std::array<RuleValue, kRules> out;
  for (std::size_t r = 0; r < kRules; ++r)
    out[r] = {share_of(by_cave(e, choices, [r](const LeftOut& l) { return l.by[r].best; })),
              share_of(by_cave(e, choices, [r](const LeftOut& l) { return l.by[r].within; })),
              share_of(by_cave(e, choices, [r](const LeftOut& l) { return l.by[r].lost; }))};
  return out;
}

LeaveOneOut leave_one_out(const Experience& e, const std::vector<std::string>& names,
                          const std::string& asked_in) {
  const std::string source = e.source.empty() ? asked_in : e.source;
  LeaveOneOut out{names, {}, 0, 0, {}, {}, {}};
  std::vector<std::size_t> metrics;
  for (const std::string& name : names) {
    metrics.push_back(metric_of(e, name, source));
    evaluation::better_sign(name, source);
    if (const std::size_t known = caves_with(e, metrics.back()); known < kFewestCaves + 1)
      throw core::InputError(source, name,
                             "is known of " + core::counted(known, "cave") + "; " +
                                 std::to_string(kFewestCaves + 1) +
                                 " at least are needed to leave one out and select from the others");
  }
  if (metrics.empty()) throw core::InputError(source, "", "no goal is known of five caves or more");
  for (std::size_t c = 0; c < e.caves.size(); ++c) {
    std::optional<LeftOutCave> left_out;
    bool chosen = false;
    for (const std::size_t m : metrics)
      for (std::size_t s = 0; s < e.sites.size(); ++s) {
        if (e.sites[s].cave != c) continue;
        if (!left_out) left_out.emplace(e, metrics, c);
        if (const auto choice = left_out->choice(s, m)) {
          out.choices.push_back(*choice);
          out.refused += choice->refused;
          chosen = true;
        }
      }
    out.caves += chosen;
  }
  if (out.choices.empty()) throw core::InputError(source, names.front(), "no cave was flown by two policies");
  out.all = value_of(e, out.choices);
  std::vector<LeftOut> answered;
  std::copy_if(out.choices.begin(), out.choices.end(), std::back_inserter(answered),
               [](const LeftOut& l) { return !l.refused; });
  out.answered = value_of(e, answered);
  const auto lost = [&](std::size_t r) {
    return by_cave(e, out.choices, [r](const LeftOut& l) { return l.by[r].lost; });
  };
  for (std::size_t r = 0; r < kRules; ++r) out.lost_ratio[r] = ratio_of(lost(0), lost(r));
  return out;
}

}  // namespace karst::selection
