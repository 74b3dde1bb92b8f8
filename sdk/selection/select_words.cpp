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
constexpr double kMaxAlike = 1.5;         // times the weight each cave would have if all had the same

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

bool likeness_tells_nothing(const Experience& e, const Selected& s) {
  // With a wide bandwidth all caves have nearly equal weight: similarity of the nearest ones decides nothing.
  const bool alike = s.near.front().weight < kMaxAlike / static_cast<double>(e.caves.size());
  return !s.flown && (std::isinf(s.bandwidth) || alike);
}

std::string confidence_in_words(const Experience& e, const Selected& s) {
  const double share = std::min(s.confidence, kMostOfASample);
  std::string out = "first in " + share_text(share) + " of 1000 resamplings of the earlier flights";
  if (s.ranking.size() > 1 && overlap(s.ranking[0], s.ranking[1]))
    out += "; its interval overlaps that of " + e.contestants[s.ranking[1].contestant].name +
           ", so either may do better in this cave";
  return out;
}

std::string why_first(const Experience& e, const Selected& s, const SelectOptions& options) {
  const std::string name = e.contestants[s.ranking.front().contestant].name,
                    metric = metric_words(options.metric) + " (" + options.metric + ")",
                    flights =
                        format_text(" The flights lasted at most %g s, in profile ", e.flown.horizon_s) +
                        e.flown.profile + ".";
  if (s.flown)
    return name + " did best in " + metric + " in this very cave, among " +
           core::counted(s.ranking.size(), "contestant") + "." + flights;
  std::string out = name + " did best in " + metric + ", on average over the " +
                    core::counted(s.near.size(), "cave") + " flown.";
  if (likeness_tells_nothing(e, s))
    out +=
        " All caves count alike: when each was left out in turn, those most like it did not foretell which "
        "policy is best there.";
  else
    out += " Caves that are more like this one count more.";
  out += " Most like it:";
  for (std::size_t i = 0; i < s.near.size() && i < 3; ++i)
    out += format_text("%s %s (distance %.2f)", i ? "," : "", e.caves[s.near[i].cave].name.c_str(),
                       s.near[i].distance.value);
  return out + "." + flights;
}

}  // namespace karst::selection
