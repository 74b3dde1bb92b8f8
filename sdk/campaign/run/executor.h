// Flies trials as processes of this machine, one a core, and never more: each into a folder that gets its
// name only once the trial has ended, so that what has a name is whole.
#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sdk/host/isolation/process.h"

namespace karst::campaign {

using host::ProcessEnd;

struct TrialJob {
  std::vector<std::string> command;  // without its run directory: "--out DIR" is put behind it
  std::filesystem::path run_dir;
  std::string identity;  // of what is flown, for the note
};

struct ExecutorOptions {
  std::size_t jobs = 1;
  double timeout_s = 7200;
  std::filesystem::path flying;  // folder for trials under way, on the run directories' file system
  /// Called with the folder of a trial that has ended, before it gets its name.
  std::function<void(const std::filesystem::path& folder)> finish;
  const std::atomic<bool>* stop = nullptr;
};

/// Called about ten times a second with how many fly, and after each end.
struct ExecutorEvents {
  std::function<void(std::size_t job, const ProcessEnd& end)> ended;
  std::function<void(std::size_t flying)> tick;
};

/// Runs all jobs in their order; returns false if stopped before the last had ended: what was under way then
/// is gone. Throws core::InputError if the disk is full or cannot be written: that is no result of a trial.
bool run_trials(const std::vector<TrialJob>& jobs, const ExecutorOptions& options,
                const ExecutorEvents& events);

/// How a run directory's trial ended, as written beside its record: `trial.json`.
struct TrialNote {
  ProcessEnd end;
  std::string machine, identity;
};
void write_note(const std::filesystem::path& run_dir, const TrialNote& note);
/// Throws core::InputError if it is not there or cannot be read.
TrialNote read_note(const std::filesystem::path& run_dir);

constexpr const char* kLogFile = "output.txt";  // what the trial printed

}  // namespace karst::campaign
