// Flies trials as processes on this machine, at most one per core: each in a folder that gets its final name
// only after the trial has ended, so that a named folder is always complete. If another machine has flown the
// same trial meanwhile, its folder stays: nobody sees a folder change.
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
  std::vector<std::string> command;  // without its run directory: "--out DIR" is appended
  std::filesystem::path run_dir;
  std::string identity;  // of the mission flown, for the note
};

struct ExecutorOptions {
  std::size_t jobs = 1;
  double timeout_s = 7200;
  std::filesystem::path flying;  // folder for running trials, on the run directories' file system
  /// Called with the folder of a finished trial, before the folder is renamed.
  std::function<void(const std::filesystem::path& folder)> finish;
  const std::atomic<bool>* stop = nullptr;
};

/// Called about ten times a second with the number of running trials, and after each trial.
struct ExecutorEvents {
  std::function<void(std::size_t job, const ProcessEnd& end)> ended;
  std::function<void(std::size_t flying)> tick;
  std::function<void(const std::string& text)> say = {};    // what the user should know, such as a lost node
  std::function<void(const std::string& text)> queue = {};  // how many tasks run and wait, before each tick
};

/// Runs all jobs in order; returns false if stopped before the last one ended: running trials are discarded.
/// Throws core::InputError if the disk is full or not writable: that is not a result of a trial.
bool run_trials(const std::vector<TrialJob>& jobs, const ExecutorOptions& options,
                const ExecutorEvents& events);

/// How the trial of a run directory ended; written beside its record as `trial.json`.
struct TrialNote {
  ProcessEnd end;
  std::string machine, identity;
};
void write_note(const std::filesystem::path& run_dir, const TrialNote& note);
/// Throws core::InputError if the file is missing or cannot be read.
TrialNote read_note(const std::filesystem::path& run_dir);
/// Whether exactly this trial has been flown.
bool is_flown(const TrialJob& job);

constexpr const char* kLogFile = "output.txt";  // the trial's output

}  // namespace karst::campaign
