// Wording of the verdict.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/unit_text.h"
#include "sdk/campaign/verdict/figure_words.h"
#include "sdk/campaign/verdict/verdict_parts.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {
namespace {

using core::counted;

using evaluation::Forecast;
using evaluation::MetricDefinition;

const MetricDefinition& definition(int metric) {
  return evaluation::metric_definitions()[static_cast<std::size_t>(metric)];
}

std::string unit_of(const MetricDefinition& d) {
  if (is_fraction(d)) return " points";
  return d.unit.empty() ? "" : " " + core::unit_text(d.unit);
}

/// Uses as many decimals as two significant digits of `scale` need.
std::string number(double v, double scale) { return fixed_text(v, decimals_for(scale, 2)); }

std::string p_text(double p) {
  if (p < 0.001) return "p < 0.001";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), p < 0.1 ? "p = %.3f" : "p = %.2f", p);
  return text.data();
}

/// The comparisons of two contestants in one figure, for which p is corrected.
std::size_t comparisons_of(std::size_t contestants) { return contestants * (contestants - 1) / 2; }

/// "6 caves x 10 seeds", or "57 pairs in 6 caves" if caves differ in their number of pairs.
std::string sample(const Comparison& c) {
  const bool even = std::all_of(c.per_cave.begin(), c.per_cave.end(),
                                [&](auto& cave) { return cave.pairs == c.per_cave.front().pairs; });
  if (even) return counted(c.caves, "cave") + " x " + counted(c.per_cave.front().pairs, "seed");
  return counted(c.pairs, "pair") + " in " + counted(c.caves, "cave");
}

std::string failures(const Comparison& c, const CampaignResults& results) {
  std::string text;
  for (const auto& [contestant, failed] : {std::pair(c.a, c.failed_a), std::pair(c.b, c.failed_b)})
    if (failed > 0)
      text += (text.empty() ? "" : ", ") + counted(failed, "trial") + " of " +
              results.contestants[contestant].name + " failed";
  return text.empty() ? "" : "; " + text;
}

/// As in the tables, a minus b; or without its sign, where words say who has more.
enum class Signed { as_a_minus_b, positive };

/// The size of the difference with its interval, which has the same sign.
std::string size_of(const Comparison& c, const CampaignResults& results, const VerdictOptions& options,
                    Signed as) {
  const MetricDefinition& d = definition(c.metric);
  const double factor = is_fraction(d) ? 100 : 1,
               sign = as == Signed::positive && c.difference < 0 ? -factor : factor;
  double low = sign * c.interval.low, high = sign * c.interval.high;
  if (low > high) std::swap(low, high);
  const double scale = std::isnan(low) ? std::abs(factor * c.difference) : (high - low) / 5;
  const std::size_t compared = comparisons_of(results.contestants.size());
  std::string text = number(sign * c.difference, scale) + unit_of(d) + " (";
  if (!std::isnan(low))
    text += number(100 * (1 - options.alpha), 10) + " % CI " + number(low, scale) + " to " +
            number(high, scale) + unit_of(d) + (c.few_seeds ? " over caves; " : "; ");
  return text + sample(c) + ", " + p_text(c.p_corrected) +
         (compared > 1 ? " after correction for " + std::to_string(compared) + " comparisons" : "") +
         failures(c, results) + ")";
}

/// The reason for no shown difference, if the interval alone does not tell. The interval is of the mean and
/// is not corrected; p is of the pairs' signed ranks and is. So one may show what the other does not.
std::string why_none(const Comparison& c, const CampaignResults& results, const VerdictOptions& options) {
  // Pairs that all favour one side have p = 2 / 2^pairs, times the pairs of contestants after correction.
  const std::size_t compared = comparisons_of(results.contestants.size());
  const double min_p = std::ldexp(2.0, -static_cast<int>(c.pairs)) * static_cast<double>(compared);
  const std::string bound = core::format_text("%g", options.alpha);
  if (min_p >= options.alpha)
    return "; " + counted(c.pairs, "pair") + " cannot show any: p would have to be below " + bound +
           ", and of so few it is " + core::format_text("%.2g", std::min(1.0, min_p)) + " at least";
  if (!c.interval.excludes(0) || c.p_corrected < options.alpha) return "";
  if (c.test.p < options.alpha)
    return "; the interval, which is not corrected, excludes zero, and by itself this pair would show a "
           "difference (" +
           p_text(c.test.p) + "), but after correction p is not below " + bound;
  return "; the means differ, but pairs fall either way: their test, which decides, gives no p below " +
         bound + (c.caves > 1 ? ", and who is ahead depends on the cave" : "");
}

std::string seeds_text(const Comparison& c, const VerdictOptions& options) {
  const Forecast& f = c.forecast_worthwhile;
  const MetricDefinition& d = definition(c.metric);
  const double factor = is_fraction(d) ? 100 : 1, effect = factor * c.worthwhile;
  const std::string difference = "a difference of " + number(100 * options.worthwhile, 10) + " % (" +
                                 number(effect, effect) + unit_of(d) + ")";
  if (options.simulations == 0) return "";
  if (c.few_seeds) return "; two seeds a cave or more would tell how many show " + difference;
  if (f.seeds >= Forecast::kNever) return "; " + difference + " would need a thousand seeds a cave or more";
  int flown = Forecast::kNever;
  for (const CaveComparison& cave : c.per_cave) flown = std::min(flown, static_cast<int>(cave.pairs));
  if (f.seeds <= flown) return "; " + difference + " would most likely have been shown";
  const auto more = [&](int seeds) { return std::to_string(std::max(0, seeds - flown)); };
  return "; about " + more(f.seeds) + " more seed" + (f.seeds - flown == 1 ? "" : "s") + " a cave (" +
         more(f.low) + " to " + (f.high >= Forecast::kNever ? "a thousand" : more(f.high)) + ") would show " +
         difference;
}

std::string names_of(const std::vector<RankedContestant>& places, const CampaignResults& results) {
  std::vector<std::string> names;
  for (const RankedContestant& place : places) names.push_back(results.contestants[place.contestant].name);
  return listed(names);
}

}  // namespace

std::string sentence_of(const Comparison& c, const CampaignResults& results, const VerdictOptions& options) {
  const MetricDefinition& d = definition(c.metric);
  const std::string &a = results.contestants[c.a].name, &b = results.contestants[c.b].name;
  if (c.pairs == 0)
    return "nothing to compare in " + subject_of(d) + ": no cave and seed of which it is known of both " + a +
           " and " + b;
  if (c.shown == Shown::no_difference) {
    const std::string between = "no difference shown between " + a + " and " + b + " in " + subject_of(d);
    if (c.difference == 0 && c.test.positive + c.test.negative == 0)
      return between + ": all " + counted(c.pairs, "pair") + " equal";
    const bool primary = d.name == options.metric;
    return between + ": " + a + " minus " + b + ": " + size_of(c, results, options, Signed::as_a_minus_b) +
           why_none(c, results, options) + (primary ? seeds_text(c, options) : "");
  }
  // The better contestant is named first; for figures without a better direction, the one with more.
  const bool a_first = c.shown == Shown::a_better || c.shown == Shown::a_more;
  return (a_first ? a : b) + " " + verb_of(d, a_first == (c.difference > 0)) + " " + (a_first ? b : a) +
         ": " + size_of(c, results, options, Signed::positive);
}

std::string sentence_of(const Verdicts& verdicts, const CampaignResults& results) {
  const std::vector<RankedContestant>& ranking = verdicts.ranking;
  if (ranking.size() < 2) return "nothing to compare: a verdict needs two contestants";
  if (ranking.size() == 2) return verdicts.find(0, 1, verdicts.metric)->sentence;
  const std::string by = " in " + subject_of(definition(verdicts.metric));
  std::vector<RankedContestant> first;  // those to which no contestant is shown to be better
  std::copy_if(ranking.begin(), ranking.end(), std::back_inserter(first),
               [](const RankedContestant& p) { return p.best == 1; });
  if (first.size() == ranking.size() && ranking.front().worst == static_cast<int>(ranking.size()))
    return "no difference shown" + by + " between any two of " + names_of(ranking, results);
  if (first.empty())  // cyclic: a better than b, b than c, c than a, on different trials
    return "each of " + names_of(ranking, results) + " is shown worse than another" + by;
  if (first.size() > 1) return "nobody is shown to be better" + by + " than " + names_of(first, results);
  const std::size_t best = first.front().contestant;
  const RankedContestant& second = ranking[ranking[0].contestant == best ? 1 : 0];
  const Comparison* next = verdicts.find(best, second.contestant, verdicts.metric);
  const bool over_all = first.front().worst == 1;
  return results.contestants[best].name + " is best" + by +
         (over_all ? ", shown better than all others; the next: "
                   : ", though not shown better than all others; ") +
         next->sentence;
}

}  // namespace karst::campaign
