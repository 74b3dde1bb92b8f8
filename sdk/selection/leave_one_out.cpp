#include "sdk/selection/leave_one_out.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::selection {
namespace {

bool better(const std::string& metric, double a, double b) {
  const int i = evaluation::metric_index(metric);
  const bool more =
      evaluation::metric_definitions()[static_cast<std::size_t>(i)].better == evaluation::Better::more;
  return more ? a > b : a < b;
}

bool as_good(double value, double best) { return std::abs(value - best) <= kAsGood * std::abs(best) + 1e-12; }

/// The lost fraction of the best value.
double lost(double value, double best) {
  return best == 0 ? std::abs(value) : std::abs(value - best) / std::abs(best);
}

/// The same contestant for any cave: the best one if all caves have equal weight.
Selected regardless_of_cave(const Experience& rest, const SelectOptions& options, const std::string& source) {
  Experience alike = rest;
  for (KnownCave& c : alike.caves) c.figures = {.volume_m3 = 1000};
  return select(alike, {.volume_m3 = 1000}, options, source);
}

void add(LeaveOneOut::Shares& s, bool best, bool within, double regret) {
  s.best += best;
  s.within += within;
  s.regret += regret;
}

void divide(LeaveOneOut::Shares& s, std::size_t n) {
  const double d = n > 0 ? static_cast<double>(n) : kUnknown;
  s.best /= d;
  s.within /= d;
  s.regret /= d;
}

}  // namespace

LeaveOneOut leave_one_out(const Experience& e, const SelectOptions& options, const std::string& asked) {
  const std::string source = e.source.empty() ? asked : e.source;
  const auto found = std::find(e.metrics.begin(), e.metrics.end(), options.metric);
  if (found == e.metrics.end())
    throw core::InputError(source, options.metric, "policies are not selected by this figure");
  const auto metric = static_cast<std::size_t>(found - e.metrics.begin());
  std::size_t known = 0;
  for (std::size_t c = 0; c < e.caves.size(); ++c)
    for (std::size_t k = 0; k < e.contestants.size(); ++k)
      if (e.at(k, c, metric).flights > 0) {
        ++known;
        break;
      }
  if (known < kFewestCaves + 1)
    throw core::InputError(source, options.metric,
                           "is known of " + core::counted(known, "cave") + "; " +
                               std::to_string(kFewestCaves + 1) +
                               " at least are needed to leave one out and select from the others");
  LeaveOneOut out;
  for (std::size_t c = 0; c < e.caves.size(); ++c) {
    LeftOut l;
    l.cave = c;
    std::vector<std::size_t> flew;
    for (std::size_t k = 0; k < e.contestants.size(); ++k)
      if (e.at(k, c, metric).flights > 0) flew.push_back(k);
    if (flew.size() < 2) continue;
    const auto value = [&](std::size_t k) { return e.at(k, c, metric).mean; };
    l.best = *std::min_element(flew.begin(), flew.end(), [&](std::size_t a, std::size_t b) {
      return better(options.metric, value(a), value(b));
    });
    l.best_value = value(l.best);
    const Experience rest = without_cave(e, c);
    const auto first_that_flew = [&](const Selected& s) {
      for (const Expected& x : s.ranking)
        if (e.at(x.contestant, c, metric).flights > 0) return x.contestant;
      return flew.front();
    };
    const Selected s = select(rest, e.caves[c].figures, options, source);
    l.selected = first_that_flew(s);
    l.overall = first_that_flew(regardless_of_cave(rest, options, source));
    l.refused = s.refused;
    l.nearest = s.near.front().distance.value;
    l.selected_value = value(l.selected);
    l.overall_value = value(l.overall);
    l.selected_within = as_good(l.selected_value, l.best_value);
    l.overall_within = as_good(l.overall_value, l.best_value);
    double chance_regret = 0;
    for (const std::size_t k : flew) {
      l.chance_value += value(k) / static_cast<double>(flew.size());
      l.chance_best += (value(k) == l.best_value) / static_cast<double>(flew.size());
      l.chance_within += as_good(value(k), l.best_value) / static_cast<double>(flew.size());
      chance_regret += lost(value(k), l.best_value) / static_cast<double>(flew.size());
    }
    const auto count = [&](LeaveOneOut::Shares& selected, LeaveOneOut::Shares& overall,
                           LeaveOneOut::Shares& chance) {
      add(selected, l.selected_value == l.best_value, l.selected_within,
          lost(l.selected_value, l.best_value));
      add(overall, l.overall_value == l.best_value, l.overall_within, lost(l.overall_value, l.best_value));
      chance.best += l.chance_best;
      chance.within += l.chance_within;
      chance.regret += chance_regret;
    };
    count(out.selected, out.overall, out.chance);
    if (l.refused)
      ++out.refused;
    else
      count(out.selected_answered, out.overall_answered, out.chance_answered);
    out.caves.push_back(l);
  }
  if (out.caves.empty()) throw core::InputError(source, options.metric, "no cave was flown by two policies");
  for (auto* s : {&out.selected, &out.overall, &out.chance}) divide(*s, out.caves.size());
  for (auto* s : {&out.selected_answered, &out.overall_answered, &out.chance_answered})
    divide(*s, out.caves.size() - out.refused);
  return out;
}

}  // namespace karst::selection
