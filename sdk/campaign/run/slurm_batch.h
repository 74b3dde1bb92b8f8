// The work of a Slurm task: a file with trials, which `karst trials` flies on a node.
#pragma once
#include <atomic>
#include <filesystem>
#include <vector>

#include "sdk/campaign/run/executor.h"

namespace karst::campaign {

struct Batch {
  std::vector<TrialJob> trials;
  std::filesystem::path karst, flying;  // as in ExecutorOptions
  double timeout_s = 7200;
};
void write_batch(const std::filesystem::path& file, const Batch& batch);

/// Flies the trials of a batch file in order, as many at once as Slurm gave CPUs to the task. Skips trials
/// already flown. Returns false if stopped.
bool fly_batch(const std::filesystem::path& file, const std::atomic<bool>* stop);

/// Evaluates the record of a crashed trial up to its end, unless there are figures already.
void evaluate_record(const std::filesystem::path& karst, const std::filesystem::path& run_dir);

}  // namespace karst::campaign
