#include "sdk/campaign/run/slurm.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/program_in_path.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/host/isolation/process.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using core::InputError;
using host::ProcessOutput;
using host::run_process;
using nlohmann::json;

constexpr double kTask_s = 10;               // least duration of a task
constexpr std::size_t kTasksOfArray = 1000;  // Slurm's default MaxArraySize is 1001
constexpr int kAttempts = 2;
constexpr double kCommand_s = 120;  // time limit of a Slurm command
constexpr double kEvaluationLimit_s = 1800;
constexpr auto kPoll = std::chrono::milliseconds(500);
constexpr int kPollsOfQueue = 6;  // the queue is polled less often than the folder by this factor

std::string slurm_program(const std::string& name) {
  if (auto program = core::program_in_path(name)) return *program;
  throw InputError("slurm", name, "is not installed here, or not in PATH");
}

/// The output of a Slurm command; throws with its message if the command fails.
std::string ask(std::vector<std::string> argv) {
  const std::string name = argv[0];
  argv[0] = slurm_program(name);
  const ProcessOutput output = run_process(argv, kCommand_s);
  std::string said = output.out;
  while (!said.empty() && said.back() == '\n') said.pop_back();
  if (output.end.hung || output.end.signal || output.end.exit_code)
    throw InputError("slurm", name, describe(output.end) + (said.empty() ? "" : ": " + said));
  return said;
}

/// Whether any task of an array waits or runs. An array unknown to Slurm has ended.
bool is_active(const std::string& array) {
  const ProcessOutput queue =
      run_process({slurm_program("squeue"), "--noheader", "--jobs", array, "--format", "%T"}, kCommand_s);
  if (queue.end.exit_code != 0 && queue.out.find("Invalid job id") == std::string::npos)
    return true;  // the controller does not answer: it may still run
  return queue.end.exit_code == 0 && !queue.out.empty();
}

fs::path array_file(const SlurmOptions& o) { return o.folder / "slurm" / "array"; }

void cancel(const std::string& array) {
  ask({"scancel", array});
  while (is_active(array)) std::this_thread::sleep_for(kPoll);
}

/// Cancels an array that was left by a killed campaign.
void cancel_left_behind(const SlurmOptions& o) {
  std::string array;
  if (fs::exists(array_file(o))) core::open_input(array_file(o), core::kMaxTextFileBytes) >> array;
  if (!array.empty()) cancel(array);
  std::error_code ignored;
  fs::remove(array_file(o), ignored);
}

json batch_json(const std::vector<TrialJob>& jobs, const SlurmOptions& o) {
  json batch{{"schema", "karst.batch/1"},
             {"karst", o.karst.string()},
             {"timeout_s", o.timeout_s},
             {"flying", (o.folder / "flying").string()},
             {"trials", json::array()}};
  for (const TrialJob& j : jobs)
    batch["trials"].push_back(
        {{"command", j.command}, {"run_dir", j.run_dir.string()}, {"identity", j.identity}});
  return batch;
}

/// Writes the batches into a folder of their own and submits one array for them; returns its number.
std::string submit(const std::vector<TrialJob>& jobs, std::size_t batch, const SlurmOptions& o) {
  const fs::path dir = o.folder / "slurm" / "batches";
  std::error_code error;
  fs::remove_all(dir, error);
  fs::create_directories(dir, error);
  if (error) throw InputError(dir.string(), "", "cannot be made: " + error.message());
  std::size_t tasks = 0;
  for (std::size_t at = 0; at < jobs.size(); at += batch, ++tasks) {
    const auto begin = jobs.begin() + static_cast<std::ptrdiff_t>(at);
    const auto end = jobs.begin() + static_cast<std::ptrdiff_t>(std::min(at + batch, jobs.size()));
    evaluation::write_whole_file(dir / (std::to_string(tasks) + ".json"),
                                 core::json_text(batch_json({begin, end}, o), 1));
  }
  evaluation::write_whole_file(dir / "task.sh",
                               "#!/bin/sh\nexec \"$1\" trials \"$2/$SLURM_ARRAY_TASK_ID.json\"\n");
  std::vector<std::string> argv = {"sbatch",
                                   "--parsable",
                                   "--job-name=karst-" + o.name,
                                   "--array=0-" + std::to_string(tasks - 1),
                                   "--ntasks=1",
                                   "--cpus-per-task=1",
                                   "--chdir=" + o.folder.string(),
                                   "--output=" + (dir / "%a.txt").string()};
  argv.insert(argv.end(), o.sbatch.begin(), o.sbatch.end());
  argv.insert(argv.end(), {(dir / "task.sh").string(), o.karst.string(), dir.string()});
  const std::string printed = ask(argv);
  const std::string last =
      printed.substr(printed.rfind('\n') == std::string::npos ? 0 : printed.rfind('\n') + 1);
  std::string array = last.substr(0, last.find(';'));  // "12;cluster" where there are several
  evaluation::write_whole_file(array_file(o), array + "\n");
  return array;
}

/// Records a task that ended without a trial: out of memory, out of time, or a failed node.
void record_lost(const TrialJob& job) {
  fs::create_directories(job.run_dir);
  std::ofstream(job.run_dir / kLogFile) << "its Slurm task ended without it, " << kAttempts << " times\n";
  write_note(job.run_dir, {{0, SIGKILL, false, 0}, "slurm", job.identity});
}

class Waiting {
 public:
  Waiting(const std::vector<TrialJob>& jobs, const ExecutorEvents& events)
      : jobs_(jobs), events_(events), ended_(jobs.size()) {}
  /// Collects the run directories that have appeared.
  void look() {
    for (std::size_t i = 0; i < jobs_.size(); ++i) {
      if (ended_[i] || !is_flown(jobs_[i])) continue;
      ended_[i] = true;
      if (events_.ended) events_.ended(i, read_note(jobs_[i].run_dir).end);
    }
  }
  std::vector<TrialJob> missing() const {
    std::vector<TrialJob> jobs;
    for (std::size_t i = 0; i < jobs_.size(); ++i)
      if (!ended_[i]) jobs.push_back(jobs_[i]);
    return jobs;
  }
  bool all() const {
    return std::all_of(ended_.begin(), ended_.end(), [](bool e) { return e; });
  }

 private:
  const std::vector<TrialJob>& jobs_;
  const ExecutorEvents& events_;
  std::vector<bool> ended_;
};

/// Returns false if stopped.
bool wait_for(const std::string& array, Waiting& waiting, const SlurmOptions& o,
              const ExecutorEvents& events) {
  for (int poll = 1;; ++poll) {
    const bool over = poll % kPollsOfQueue == 0 && !is_active(array);  // asked before the folder is looked at
    waiting.look();
    if (over || waiting.all()) return true;
    if (o.stop && *o.stop) return false;
    if (events.tick) events.tick(0);
    std::this_thread::sleep_for(kPoll);
  }
}

}  // namespace

std::size_t batch_size(double expected_trial_s) {
  return static_cast<std::size_t>(std::clamp(std::ceil(kTask_s / expected_trial_s), 1.0, 1000.0));
}

bool run_on_slurm(const std::vector<TrialJob>& jobs, const SlurmOptions& o, const ExecutorEvents& events) {
  cancel_left_behind(o);
  std::error_code ignored;
  fs::remove_all(o.folder / "flying", ignored);
  Waiting waiting(jobs, events);
  waiting.look();  // trials flown before the cancellation
  for (int attempt = 0; attempt < kAttempts && !waiting.all(); ++attempt) {
    const std::vector<TrialJob> missing = waiting.missing();
    const std::size_t first = o.batch > 0 ? o.batch : batch_size(o.expected_trial_s);
    const std::size_t batch = attempt == 0 ? first : 1;  // a lost trial must not take others with it
    for (std::size_t at = 0; at < missing.size(); at += batch * kTasksOfArray) {
      const auto begin = missing.begin() + static_cast<std::ptrdiff_t>(at);
      const auto end =
          missing.begin() + static_cast<std::ptrdiff_t>(std::min(at + batch * kTasksOfArray, missing.size()));
      const std::string array = submit({begin, end}, batch, o);
      if (!wait_for(array, waiting, o, events)) {
        cancel_left_behind(o);
        return false;
      }
      fs::remove(array_file(o), ignored);
    }
  }
  for (const TrialJob& lost : waiting.missing()) record_lost(lost);
  waiting.look();
  return true;
}

bool fly_batch(const fs::path& file, const std::atomic<bool>* stop) {
  const json batch = core::json_of(core::read_input(file, core::kMaxTextFileBytes));
  std::vector<TrialJob> jobs;
  ExecutorOptions options;
  try {
    for (const json& t : batch.at("trials")) {
      TrialJob job{t.at("command"), t.at("run_dir").get<std::string>(), t.at("identity")};
      if (!is_flown(job)) jobs.push_back(job);
    }
    options.timeout_s = batch.at("timeout_s");
    options.flying = batch.at("flying").get<std::string>();
    options.finish = [karst = batch.at("karst").get<std::string>()](const fs::path& dir) {
      evaluate_record(karst, dir);
    };
  } catch (const json::exception& e) {
    throw InputError(file.string(), "", std::string("is no batch of trials: ") + e.what());
  }
  options.stop = stop;
  return run_trials(jobs, options, {});
}

bool is_flown(const TrialJob& job) {
  try {
    return fs::exists(job.run_dir) && read_note(job.run_dir).identity == job.identity;
  } catch (const InputError&) {
    return false;
  }
}

void evaluate_record(const fs::path& karst, const fs::path& run_dir) {
  if (fs::exists(run_dir / "mission.info") && !fs::exists(run_dir / "metrics.json"))
    run_process({karst.string(), "report", run_dir.string(), "--no-report"}, kEvaluationLimit_s);
}

}  // namespace karst::campaign
