// Converts a run directory to a row of the store.
#pragma once
#include <filesystem>

#include "sdk/campaign/plan/plan.h"

namespace karst::campaign {

/// Reads the results of a trial in `folder`/run_dir. A trial that crashed, hung or could not fly counts as
/// failed, with the reason and with the figures of its record, if there is one, up to its end. Throws
/// core::InputError only if the folder contains no finished trial.
StoredTrial collect(const Plan& plan, const TrialKey& trial, const std::filesystem::path& folder);

/// Path of a trial's run directory relative to the campaign's folder.
std::filesystem::path run_dir_of(const Plan& plan, const TrialKey& trial);

}  // namespace karst::campaign
