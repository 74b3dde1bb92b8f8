#include "sdk/selection/select_words.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core_stack/common/format_text.h"

namespace karst::selection {
namespace {

using core::format_text;

constexpr double kMaxAlike = 1.5;  // times the weight each cave would have if all had the same

std::string how_flown(const Experience& e) {
  return format_text("; from flights of at most %g s in profile ", e.flown.horizon_s) + e.flown.profile;
}

}  // namespace

std::string why_far(const Experience& e, const CaveFigures& cave, const NearCave& nearest, double limit) {
  const FigureDefinition& f = figure_definitions()[static_cast<std::size_t>(nearest.distance.farthest)];
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const KnownCave& k : e.caves)
    if (const double x = k.figures.*f.value; std::isfinite(x)) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  const std::string unit = f.unit.empty() ? "" : " " + std::string(f.unit);
  return format_text(
      "nothing like this cave was flown: the nearest, %s, is at distance %.2f, and caves farther than %.2f "
      "from all others were never tried; most unlike is its %s: %.3g%s, against %.3g%s there and %.3g to "
      "%.3g%s in all",
      e.caves[nearest.cave].name.c_str(), nearest.distance.value, limit, std::string(f.name).c_str(),
      cave.*f.value, unit.c_str(), e.caves[nearest.cave].figures.*f.value, unit.c_str(), low, high,
      unit.c_str());
}

std::string why_first_there(const Experience& e, const Selected& s, const SelectOptions& options) {
  const Expected& first = s.ranking.front();
  const auto metric = static_cast<std::size_t>(std::find(e.metrics.begin(), e.metrics.end(), options.metric) -
                                               e.metrics.begin());
  std::string where;
  int flights = 0;
  for (const NearCave& n : s.near)
    if (n.weight > 0) {
      where += (where.empty() ? "" : ", ") + e.caves[n.cave].name;
      flights += e.at(first.contestant, n.cave, metric).flights;
    }
  std::string out = "this very cave was flown: " + where + "; of " + std::to_string(s.ranking.size()) +
                    " contestants there " + e.contestants[first.contestant].name + " did best in " +
                    format_text("%s (%.3g over %d flights", options.metric.c_str(), first.value, flights);
  if (!std::isnan(first.low))
    out += format_text(", %.0f %% interval %.3g to %.3g", 100 * options.level, first.low, first.high);
  return out + format_text("); confidence %.0f %%", 100 * s.confidence) + how_flown(e);
}

std::string why_first(const Experience& e, const Selected& s, const SelectOptions& options) {
  const Expected& first = s.ranking.front();
  std::string out =
      format_text("%s is expected to do best in %s (%.3g", e.contestants[first.contestant].name.c_str(),
                  options.metric.c_str(), first.value);
  if (!std::isnan(first.low))
    out += format_text(", %.0f %% interval %.3g to %.3g", 100 * options.level, first.low, first.high);
  // With a wide bandwidth all caves have nearly equal weight: similarity of the nearest ones decides nothing.
  const bool alike = s.near.front().weight < kMaxAlike / static_cast<double>(e.caves.size());
  out += std::isinf(s.bandwidth) || alike
             ? ") by all caves flown alike, for what these are like did not foretell which policy is best; "
               "nearest: "
             : ") by caves like this one: ";
  for (std::size_t i = 0; i < s.near.size() && i < 3; ++i)
    out +=
        format_text("%s%s (distance %.2f, weight %.0f %%)", i ? ", " : "",
                    e.caves[s.near[i].cave].name.c_str(), s.near[i].distance.value, 100 * s.near[i].weight);
  return out + format_text("; confidence %.0f %%", 100 * s.confidence) + how_flown(e);
}

}  // namespace karst::selection
