#include "sdk/selection/select_words.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/unit_text.h"
#include "sdk/selection/figure_words.h"

namespace karst::selection {
namespace {

using core::format_text;

constexpr double kMostOfASample = 0.999;  // 1000 of 1000 resamplings are no certainty

/// Intervals that are not known may overlap.
bool overlap(const Expected& a, const Expected& b) { return !(a.low > b.high) && !(b.low > a.high); }

}  // namespace

std::string why_far(const Experience& e, const CaveFigures& cave, const NearCave& nearest, double limit) {
  const FigureDefinition& f = figure_definitions()[static_cast<std::size_t>(nearest.distance.farthest)];
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const KnownCave& k : e.caves)
    if (const double x = k.figures.*f.value; std::isfinite(x)) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  const std::string unit = f.unit.empty() ? "" : " " + core::unit_text(f.unit);
  const auto text = [&unit](double x) { return rounded_number(x) + unit; };
  return format_text(
             "nothing like this cave was flown: the nearest, %s, is at distance %.2f, and caves farther than "
             "%.2f from all others were never tried; most unlike is its ",
             e.caves[nearest.cave].name.c_str(), nearest.distance.value, limit) +
         std::string(f.name) + ": " + text(cave.*f.value) + ", against " +
         text(e.caves[nearest.cave].figures.*f.value) + " there and " + rounded_number(low) + " to " +
         text(high) + " in all";
}

bool likeness_tells_nothing(const Selected& s) { return !s.flown && std::isinf(s.fit.kernel.bandwidth); }

std::string figures_in_words(const Kernel& kernel) {
  std::string out;
  for (std::size_t f = 0; f < figure_definitions().size(); ++f)
    if (!kernel.weights.empty() && kernel.weights[f] > 0)
      out += (out.empty() ? "" : ", ") + std::string(figure_definitions()[f].name);
  return out;
}

std::string confidence_in_words(const Experience& e, const Selected& s) {
  const double share = std::min(s.confidence, kMostOfASample);
  std::string out = "first in " + share_text(share) + " of 1000 resamplings of the earlier flights";
  if (s.ranking.size() > 1 && overlap(s.ranking[0], s.ranking[1]))
    out += "; its interval overlaps that of " + e.contestants[s.ranking[1].contestant].name +
           ", so either may do better in this cave";
  return out;
}

std::string best_on_average_in_words(const Experience& e, const BestOnAverage& best,
                                     const std::string& metric) {
  return "Of the flights" + (best.vehicle.empty() ? "" : " of " + best.vehicle) + " in " +
         core::counted(best.caves, "cave") + ", those of " + e.contestants[best.contestant].name +
         " did best on average in " + metric_words(metric) + ": a choice where nothing tells more";
}

std::string runner_up_in_words(const Experience& e, const Selected& s, const std::string& metric) {
  if (s.ranking.size() < 2) return "";
  const Expected &first = s.ranking[0], &second = s.ranking[1];
  return "Runner-up: " + e.contestants[second.contestant].name + ", expected " +
         metric_value_text(metric, second.value) + " against " + metric_value_text(metric, first.value);
}

std::string evidence_in_words(const Experience& e, const Selected& s, const SelectOptions& options) {
  const Evidence& v = s.evidence;
  std::string out =
      "It rests on " + core::counted(v.flights, "flight") + " in " + core::counted(v.caves, "cave");
  if (e.conditions.size() > 1) {
    out += " under " + std::to_string(e.conditions.size()) + " conditions";
    if (!s.flown) {
      const Kernel& k = s.fit.kernel;
      out += ", " + std::to_string(v.flights_as_asked) + " of them in " +
             core::counted(v.caves_as_asked, "cave") + " as asked (" + in_words(options.conditions) + ")";
      if (!options.conditions.vehicle.empty() && k.other_vehicle < 1)
        out += format_text("; flights of other vehicles count %.0f %%", 100 * k.other_vehicle);
    }
  } else {
    out += ", all of them " + in_words(e.conditions.front());
    if (v.flights_as_asked == 0) out += "; none was as asked (" + in_words(options.conditions) + ")";
  }
  return out;
}

std::string why_first(const Experience& e, const Selected& s, const SelectOptions& options) {
  double shortest_s = std::numeric_limits<double>::infinity(), longest_s = 0;
  for (std::size_t site = 0; site < e.sites.size(); ++site)
    if (s.weights.advantage[site] > 0) {
      shortest_s = std::min(shortest_s, horizon_s(e, site));
      longest_s = std::max(longest_s, horizon_s(e, site));
    }
  const std::string name = e.contestants[s.ranking.front().contestant].name,
                    metric = metric_words(options.metric) + " (" + options.metric + ")",
                    lasted = shortest_s < longest_s ? format_text("%g or %g s", shortest_s, longest_s)
                                                    : format_text("%g s", longest_s),
                    flights = " The flights lasted at most " + lasted + ", in profile " +
                              e.conditions.front().profile + ".";
  if (s.flown)
    return name + " did best in " + metric + " in this very cave, among " +
           core::counted(s.ranking.size(), "contestant") + "." + flights;
  std::string out = name + " did best in " + metric + ", on average over the " +
                    core::counted(s.near.size(), "cave") + " flown.";
  if (likeness_tells_nothing(s))
    out +=
        " All caves count alike: when each was left out in turn, those most like it did not foretell which "
        "policy is best there.";
  else
    out += " Caves that are more like this one count more, by " + figures_in_words(s.fit.kernel) + ".";
  out += " Most like it:";
  for (std::size_t i = 0; i < s.near.size() && i < 3; ++i)
    out += format_text("%s %s (distance %.2f)", i ? "," : "", e.caves[s.near[i].cave].name.c_str(),
                       s.near[i].distance.value);
  return out + ". " + evidence_in_words(e, s, options) + "." + flights;
}

}  // namespace karst::selection
