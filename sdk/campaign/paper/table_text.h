// What the tables of a paper have in common: intervals, decimals, and how captions name interval and test.
#pragma once
#include <string>
#include <vector>

#include "sdk/campaign/store/results.h"
#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

/// "95 % CI".
std::string interval_heading(const VerdictOptions& options);

/// What an interval was drawn from; the tables mark those over caves.
enum class DrawnFrom { seeds, caves };

/// "[1.2, 3.4]", of `factor` times the interval; a dash if it is not known.
std::string interval_text(const evaluation::Interval& interval, double factor, int decimals, DrawnFrom from);

/// Decimals for a column: two digits of half the narrowest interval; without one, three of the greatest
/// number.
int common_decimals(const std::vector<evaluation::Interval>& intervals, const std::vector<double>& numbers,
                    double factor);

/// "60", or "50 to 60" where the counts differ.
std::string range_text(const std::vector<std::size_t>& counts);

/// For a caption: the test of a difference, and when one counts as shown.
std::string test_text(const CampaignResults& results, const VerdictOptions& options);

/// For a caption: how intervals are computed. `marked`: some are drawn from caves.
std::string bootstrap_text(const VerdictOptions& options, bool marked);

}  // namespace karst::campaign
