// A verdict on many contestants at a glance: the ranking in a few lines, and a matrix of all pairs.
#pragma once
#include <string>
#include <vector>

#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

/// "1-2  deep_cave 63.1 %, information_gain 61.0 %": contestants of a line are not shown to differ. At most
/// `most` lines, best first; if there are more, the last one says "the rest: " and has all others.
std::vector<std::string> ranking_lines(const Verdicts& verdicts, const CampaignResults& results,
                                       std::size_t most = 5);

/// What the matrix shows: up to ten contestants, differences in the primary figure; more, only which are
/// shown.
std::string matrix_title(const Verdicts& verdicts);
/// In the order of the ranking, row less column.
std::vector<std::string> matrix_lines(const Verdicts& verdicts, const CampaignResults& results);

}  // namespace karst::campaign
