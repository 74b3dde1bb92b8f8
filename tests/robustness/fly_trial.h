// One trial as a process of its own.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "sdk/host/isolation/process.h"
#include "tests/robustness/trial.h"

namespace karst::robustness {

struct Programs {
  std::filesystem::path karst, breaking_policy;  // the plugin breaks_later.so
};

/// The arguments of `karst fly`, its program first.
std::vector<std::string> command_of(const Trial& trial, const Programs& programs,
                                    const std::filesystem::path& cave,
                                    const std::filesystem::path& cave_cache,
                                    const std::filesystem::path& run_dir);

/// Flies it to its end, or for `limit_s` of the wall clock at most: then it hung. Sends the SIGTERM of a
/// trial that has one once the ground truth has come to its time.
host::ProcessEnd fly_trial(const Trial& trial, const std::vector<std::string>& command,
                           const std::filesystem::path& run_dir, const std::filesystem::path& log,
                           double limit_s);

}  // namespace karst::robustness
