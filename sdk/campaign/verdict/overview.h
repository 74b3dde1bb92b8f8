// A verdict on many contestants at a glance: the ranking in a few lines, and a matrix of all pairs.
#pragma once
#include <string>
#include <vector>

#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

/// "1-2  deep_cave 63.1 %, information_gain 61.0 %": contestants of the same possible ranks share a line, and
/// those beyond the last line are counted in it. At most `most` lines, best first.
std::vector<std::string> ranking_lines(const Verdicts& verdicts, const CampaignResults& results,
                                       std::size_t most = 5);

/// What the matrix shows: up to ten contestants, differences in the primary figure; more, only which are
/// shown.
std::string matrix_title(const Verdicts& verdicts);
/// In the order of the ranking, row less column.
std::vector<std::string> matrix_lines(const Verdicts& verdicts, const CampaignResults& results);

}  // namespace karst::campaign
