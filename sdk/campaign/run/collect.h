// From a run directory to a row of the store.
#pragma once
#include <filesystem>

#include "sdk/campaign/plan/plan.h"

namespace karst::campaign {

/// Reads what a trial left in `folder`/run_dir. A trial that crashed, hung or could not fly is failed, with
/// the reason and with what its record, if there is one, tells up to its end. Throws core::InputError only if
/// the folder holds no ended trial.
StoredTrial collect(const Plan& plan, const TrialKey& trial, const std::filesystem::path& folder);

/// Where a trial's run directory stands in the campaign's folder.
std::filesystem::path run_dir_of(const Plan& plan, const TrialKey& trial);

}  // namespace karst::campaign
