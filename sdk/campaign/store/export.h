// Results for other tools: CSV with one line per trial, or everything as JSON.
#pragma once
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

#include "sdk/campaign/store/results.h"
#include "sdk/campaign/store/store.h"

namespace karst::campaign {

/// A header, then one line per trial: contestant, policy, cave, seed, status, outcome, reason, ended, every
/// figure, binary_version, mission_hash, machine, wall-clock times, run_dir. Cells are quoted as RFC 4180 has
/// it (core_stack/common/csv_cell.h), lines end with LF, and unknown values are empty.
void write_csv(std::ostream& out, const CampaignResults& results, const std::vector<TrialExtras>& extras);

/// One object: `schema` "karst.results/1", the campaign, its contestants and caves, `verdict` as given, and
/// `trials` with `figures` by name and `curve` as [time_s, explored_m3, coverage]; unknown values are null.
void write_json(std::ostream& out, const CampaignResults& results, const std::vector<TrialExtras>& extras,
                const nlohmann::ordered_json& verdict);

}  // namespace karst::campaign
