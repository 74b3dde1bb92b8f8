// timing.json: machine-dependent values, kept separate from metrics.json.
#pragma once
#include <filesystem>

#include "core_stack/common/executive.h"

namespace karst::flight {

void write_timing(const std::filesystem::path& run_dir, const core::Executive& executive, double wall_s);

struct TeamTiming {
  double simulated_s = 0, wall_s = 0;
  int threads = 1;
};
/// The timing of a team as a whole; its robots' jobs are in the robots' own files.
void write_team_timing(const std::filesystem::path& run_dir, const TeamTiming& t);

}  // namespace karst::flight
