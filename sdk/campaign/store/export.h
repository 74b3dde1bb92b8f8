// Results for other tools: one line a trial as CSV, everything as JSON.
#pragma once
#include <iosfwd>

#include "sdk/campaign/store/results.h"
#include "sdk/campaign/store/store.h"

namespace karst::campaign {

/// A header, then a line a trial: contestant, policy, cave, seed, status, outcome, reason, every figure,
/// binary_version, mission_hash, machine, the times of the wall clock, run_dir. No cell holds a comma, a
/// quote or a line end (a comma in a reason becomes a semicolon), so that `awk -F,` reads it; what is not
/// known is empty.
void write_csv(std::ostream& out, const CampaignResults& results, const std::vector<TrialExtras>& extras);

/// One object: `schema` "karst.results/1", the campaign, its contestants and caves, and `trials` with
/// `figures` by name and `curve` as [time_s, explored_m3, coverage]; what is not known is null.
void write_json(std::ostream& out, const CampaignResults& results, const std::vector<TrialExtras>& extras);

}  // namespace karst::campaign
