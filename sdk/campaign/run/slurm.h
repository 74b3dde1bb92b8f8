// Flies trials as tasks of Slurm job arrays. Each task takes a batch of trials that is worth its start, flies
// them as the local executor does, and leaves run directories in the campaign's folder, which every node must
// see at the same path.
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
  double expected_trial_s = 10;     // wall clock; what batches are measured by
  std::size_t batch = 0;            // trials a task; 0: batch_size(expected_trial_s)
  std::vector<std::string> sbatch;  // further options of sbatch, such as "--partition=long"
  const std::atomic<bool>* stop = nullptr;
};

/// How many trials a task takes, so that it has at least ten seconds of work: Slurm starts about two a
/// second.
std::size_t batch_size(double expected_trial_s);

/// Flies all jobs; events.ended comes as run directories appear. A trial whose task is lost twice is a
/// result: killed. An array that a killed campaign left is cancelled first. Returns false if stopped, when
/// the array is cancelled. Throws core::InputError if Slurm cannot be asked or refuses.
bool run_on_slurm(const std::vector<TrialJob>& jobs, const SlurmOptions& options,
                  const ExecutorEvents& events);

/// What a task does: flies the trials of a batch file, one after the other. Those that are flown are left as
/// they are. Returns false if stopped.
bool fly_batch(const std::filesystem::path& batch, const std::atomic<bool>* stop);

/// Whether this very trial has been flown.
bool is_flown(const TrialJob& job);

/// The record of a trial that crashed tells what it had found until then: evaluates it, if there are no
/// figures.
void evaluate_record(const std::filesystem::path& karst, const std::filesystem::path& run_dir);

}  // namespace karst::campaign
