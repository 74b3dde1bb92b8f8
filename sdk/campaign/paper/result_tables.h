// The two tables of a campaign for a paper: the ranking of its contestants, and their comparisons in pairs.
#pragma once
#include "sdk/campaign/paper/paper_table.h"
#include "sdk/campaign/store/results.h"
#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

/// A row for each contestant, best first: its place, its mean in the primary figure with an interval, and its
/// means in the figures that `karst results` prints. All means are of the flights that every contestant flew.
PaperTable ranking_table(const CampaignResults& results, const Verdicts& verdicts,
                         const VerdictOptions& options);

/// A row for each pair of contestants, in the primary figure; without rows for a single contestant.
PaperTable comparisons_table(const CampaignResults& results, const Verdicts& verdicts,
                             const VerdictOptions& options);

}  // namespace karst::campaign
