// Wall-clock figures of a run: they differ between flights, so they are kept apart from metrics.json.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace karst::evaluation {

/// NaN where the record lacks the data.
struct WallClock {
  double wall_s, simulated_s, simulated_s_per_wall_s;
  double decide_mean_ms, decide_p99_ms, decide_max_ms;  // of the policy's decisions
  double plan_mean_ms, plan_p99_ms, plan_max_ms;        // of planning to the goals it proposed
};

/// Reads timing.json and decisions.csv of a run directory. A missing file leaves its figures NaN; so does a
/// damaged one, and a sentence is added to `problems`. p99: the value that 99 % do not exceed (nearest rank).
WallClock read_wall_clock(const std::filesystem::path& run_dir, std::vector<std::string>& problems);

}  // namespace karst::evaluation
