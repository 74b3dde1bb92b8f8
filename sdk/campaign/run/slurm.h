// Flies trials as tasks of Slurm job arrays. Each task takes a batch of trials large enough to justify its
// start, flies them as the local executor does, and leaves run directories in the campaign's folder, which
// every node must see under the same path.
#pragma once
#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "sdk/campaign/run/executor.h"

namespace karst::campaign {

struct SlurmOptions {
  std::filesystem::path folder, karst;
  std::string name;
  double timeout_s = 7200;
  double expected_trial_s = 10;     // wall clock; determines the batch size
  std::size_t batch = 0;            // trials per task; 0: batch_size(expected_trial_s)
  std::vector<std::string> sbatch;  // additional options of sbatch, such as "--partition=long"
  double late_s = 90;   // a shared disk may show a finished trial that much later: NFS caches 60 s
  double look_s = 0.5;  // between looks at the folder; the queue is asked six times less often
  const std::atomic<bool>* stop = nullptr;
};

/// Number of trials per task such that a task takes at least ten seconds: Slurm starts about two tasks a
/// second.
std::size_t batch_size(double expected_trial_s);

/// Flies all jobs; calls events.ended when a run directory appears. A trial whose task is lost twice has the
/// result "killed". (A task that Slurm itself starts again, because its node was lost, does not count.) First
/// cancels arrays left by a killed campaign. If stopped, cancels its arrays and returns false. Throws
/// core::InputError, with nothing left flying, if Slurm is not reachable or refuses, if tasks are cancelled
/// by somebody, or if they end twice for a reason other than their trials.
bool run_on_slurm(const std::vector<TrialJob>& jobs, const SlurmOptions& options,
                  const ExecutorEvents& events);

}  // namespace karst::campaign
