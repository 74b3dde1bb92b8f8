// The cave of a trial as files: generated where it has to be, with the trial's fault in its description.
#pragma once
#include <filesystem>

#include "tests/robustness/trial.h"

namespace karst::robustness {

/// Writes `info`, a cave file for `karst fly`. Generated caves are kept in `caves` and shared by trials.
/// Throws core::InputError if the cave cannot be generated or read.
void write_trial_cave(const Trial& trial, const std::filesystem::path& karst,
                      const std::filesystem::path& caves, const std::filesystem::path& info);

}  // namespace karst::robustness
