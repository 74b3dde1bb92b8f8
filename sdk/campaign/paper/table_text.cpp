#include "sdk/campaign/paper/table_text.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sdk/campaign/paper/printed_figure.h"
#include "sdk/campaign/verdict/figure_words.h"

namespace karst::campaign {
namespace {

using evaluation::Interval;

constexpr const char* kOverCaves = " \u2020";

}  // namespace

std::string interval_heading(const VerdictOptions& options) {
  return fixed_text(100 * (1 - options.alpha), 0) + " % CI";
}

std::string interval_text(const Interval& i, double factor, int decimals, DrawnFrom from) {
  if (std::isnan(i.low) || std::isnan(i.high)) return "\u2013";
  return "[" + printed_number(factor * i.low, decimals) + ", " + printed_number(factor * i.high, decimals) +
         "]" + (from == DrawnFrom::caves ? kOverCaves : "");
}

int common_decimals(const std::vector<Interval>& intervals, const std::vector<double>& numbers,
                    double factor) {
  double narrowest = std::numeric_limits<double>::infinity(), greatest = 0;
  for (const Interval& i : intervals)
    if (i.high > i.low) narrowest = std::min(narrowest, factor * (i.high - i.low) / 2);
  if (std::isfinite(narrowest)) return std::min(4, decimals_for(narrowest, 2));
  for (const double v : numbers)
    if (std::isfinite(v)) greatest = std::max(greatest, factor * std::abs(v));
  return greatest > 0 ? std::min(4, decimals_for(greatest, 3)) : 0;
}

std::string range_text(const std::vector<std::size_t>& counts) {
  if (counts.empty()) return "0";
  const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
  return *least == *most ? std::to_string(*least) : std::to_string(*least) + " to " + std::to_string(*most);
}

std::string test_text(const CampaignResults& results, const VerdictOptions& options) {
  const std::size_t n = results.contestants.size(), pairs = n * (n - 1) / 2;
  return "Wilcoxon's signed-rank test, two-sided, over pairs of flights with the same cave and seed" +
         (pairs > 1
              ? "; p is corrected for " + std::to_string(pairs) + " pairs of contestants with Holm's method"
              : std::string()) +
         "; a difference is shown if its interval excludes zero and p < " +
         fixed_text(options.alpha, decimals_for(options.alpha, 1));
}

std::string bootstrap_text(const VerdictOptions& options, bool marked) {
  return interval_heading(options) + ": bootstrap over seeds within the caves, " +
         std::to_string(options.resamples) + " resamples" +
         (marked ? "; \u2020: over caves, because a cave has too few seeds" : "");
}

}  // namespace karst::campaign
