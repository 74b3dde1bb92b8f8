// Parts of the verdict: pairing, judging, wording, ranking.
#pragma once
#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

/// Pairs trials of the same cave and seed in one figure: fills counts, pairs and means of a Comparison. The
/// trials of a and of b must be sorted by cave and seed.
void pair_trials(const std::vector<const TrialResult*>& trials_a,
                 const std::vector<const TrialResult*>& trials_b, double horizon_s, Comparison& comparison);

/// A comparison's differences by cave, in the order of `per_cave`.
evaluation::Differences differences_of(const Comparison& comparison);

/// The sentence about one pair in one figure.
std::string sentence_of(const Comparison& comparison, const CampaignResults& results,
                        const VerdictOptions& options);
/// The sentence about the campaign.
std::string sentence_of(const Verdicts& verdicts, const CampaignResults& results);

/// Best first; `verdicts` must already hold the comparisons.
std::vector<RankedContestant> rank_contestants(const Verdicts& verdicts, const CampaignResults& results);

}  // namespace karst::campaign
