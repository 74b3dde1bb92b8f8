// timing.json: machine-dependent values, kept separate from metrics.json.
#pragma once
#include <filesystem>
#include <utility>
#include <vector>

#include "core_stack/common/executive.h"
#include "core_stack/mission/state/load_shedding.h"
#include "sdk/flight/real_time.h"

namespace karst::flight {

/// Of a flight in real time.
struct RealTimeTiming {
  std::vector<Grant> grants;
  std::vector<std::pair<core::Relief, int>> degraded;  // and how often
};

/// `real_time`: null for a flight in lockstep.
void write_timing(const std::filesystem::path& run_dir, const core::Executive& executive, double wall_s,
                  const RealTimeTiming* real_time = nullptr);

struct TeamTiming {
  double simulated_s = 0, wall_s = 0;
  int threads = 1;
};
/// The timing of a team as a whole; its robots' jobs are in the robots' own files.
void write_team_timing(const std::filesystem::path& run_dir, const TeamTiming& t);

}  // namespace karst::flight
