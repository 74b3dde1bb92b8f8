#include "sdk/campaign/run/slurm.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <set>
#include <thread>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "sdk/campaign/run/slurm_batch.h"
#include "sdk/campaign/run/slurm_tasks.h"
#include "sdk/evaluation/record/whole_file.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using core::counted;
using core::InputError;
using Clock = std::chrono::steady_clock;

constexpr double kTask_s = 10;               // least duration of a task
constexpr std::size_t kTasksOfArray = 1000;  // Slurm's default MaxArraySize is 1001
constexpr std::size_t kTasksWaiting = 500;   // so many at least: nodes that become free find one
constexpr int kLooksAPoll = 6;               // the queue is asked less often than the folder by this factor
constexpr int kRest = 20;  // asking takes at most a twentieth of the time, however slow the controller is
constexpr auto kLongestRest = std::chrono::seconds(60);
constexpr auto kSilence = std::chrono::seconds(30);   // then it is said why nothing runs
constexpr auto kTryAgain = std::chrono::seconds(30);  // to submit

fs::path arrays_file(const SlurmOptions& o) { return o.folder / "slurm" / "array"; }
fs::path batches(const SlurmOptions& o) { return o.folder / "slurm" / "batches"; }

std::set<std::string> left_behind(const SlurmOptions& o) {
  std::set<std::string> arrays;
  if (!fs::exists(arrays_file(o))) return arrays;
  std::ifstream in = core::open_input(arrays_file(o), core::kMaxTextFileBytes);
  for (std::string array; in >> array;) arrays.insert(array);
  return arrays;
}

void note(const std::set<std::string>& arrays, const SlurmOptions& o) {
  std::error_code ignored;
  if (arrays.empty()) fs::remove(arrays_file(o), ignored);
  std::string text;
  for (const std::string& array : arrays) text += array + "\n";
  if (!arrays.empty()) evaluation::write_whole_file(arrays_file(o), text);
}

/// The CPUs of a task: `--cpus-per-task` among the further options of sbatch.
std::size_t cpus_of_task(const SlurmOptions& o) {
  std::size_t cpus = 1;
  for (const std::string& option : o.sbatch)
    if (option.starts_with("--cpus-per-task="))
      cpus = std::max<std::size_t>(1, std::strtoull(option.c_str() + option.find('=') + 1, nullptr, 10));
  return cpus;
}

/// A campaign while Slurm flies it.
class Submission {
 public:
  Submission(const std::vector<TrialJob>& jobs, const SlurmOptions& o, const ExecutorEvents& events)
      : jobs_(jobs), o_(o), events_(events), tasks_(jobs, events, o.late_s) {
    const std::size_t first = o.batch > 0 ? o.batch : cpus_of_task(o) * batch_size(o.expected_trial_s);
    tasks_.plan(first);
  }

  /// Returns false if stopped.
  bool fly() {
    for (bool states_are_new = false;; states_are_new = false) {
      if (o_.stop && *o_.stop) return false;
      if (Clock::now() >= next_poll_) states_are_new = poll();
      tasks_.settle(states_are_new);
      note_arrays();
      if (tasks_.has_todo() && tasks_.waiting() < kTasksWaiting && Clock::now() >= next_submission_) submit();
      if (tasks_.all()) return true;
      tell();
      std::this_thread::sleep_for(std::chrono::duration<double>(o_.look_s));
    }
  }
  void cancel() {
    cancel_arrays(arrays_, events_.say);
    note({}, o_);
  }

 private:
  bool poll() {
    const auto begin = Clock::now();
    const std::optional<TaskStates> states = ask_queue(tasks_.arrays());
    const auto end = Clock::now();
    const Clock::duration rest = std::min<Clock::duration>(kRest * (end - begin), kLongestRest);
    next_poll_ = end + (states ? std::max(queue_poll(), rest) : queue_poll());
    if (!states && !is_mute_) say("squeue does not answer; waits for it");
    is_mute_ = !states;
    if (states) tasks_.take(*states);
    return states.has_value();
  }

  /// Writes the batches of an array into a folder of their own, and submits the array.
  void submit() {
    std::vector<SlurmTask> tasks = tasks_.next(kTasksOfArray);
    const fs::path dir = batches(o_) / std::to_string(++submissions_);
    std::error_code error;
    fs::create_directories(dir, error);
    if (error) throw InputError(dir.string(), "", "cannot be made: " + error.message());
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      tasks[i].log = dir / (std::to_string(i) + ".txt");
      write_batch(dir / (std::to_string(i) + ".json"), of(tasks[i]));
    }
    evaluation::write_whole_file(dir / "task.sh",
                                 "#!/bin/sh\nexec \"$1\" trials \"$2/$SLURM_ARRAY_TASK_ID.json\"\n");
    std::vector<std::string> arguments = {"--parsable",
                                          "--requeue",  // of a node that is lost
                                          "--job-name=karst-" + o_.name,
                                          "--array=0-" + std::to_string(tasks.size() - 1),
                                          "--ntasks=1",
                                          "--cpus-per-task=1",
                                          "--chdir=" + o_.folder.string(),
                                          "--output=" + (dir / "%a.txt").string()};
    if (const std::string bad = tasks_.bad_nodes(); !bad.empty()) {
      say("no further tasks for " + bad + ", where tasks could not fly their trials");
      arguments.push_back("--exclude=" + bad);
    }
    arguments.insert(arguments.end(), o_.sbatch.begin(), o_.sbatch.end());
    arguments.insert(arguments.end(), {(dir / "task.sh").string(), o_.karst.string(), dir.string()});
    std::string array;
    try {
      array = submit_array(arguments);
    } catch (const InputError& refused) {
      if (submissions_ == 1 || !may_pass(refused.what())) throw;
      say(std::string("tries again in half a minute: ") + refused.what());
      next_submission_ = Clock::now() + kTryAgain;
      return;
    }
    arrays_.insert(array);
    note(arrays_, o_);
    std::size_t trials = 0;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      tasks[i].id = {array, i};
      trials += tasks[i].trials.size();
    }
    tasks_.submitted(tasks);
    say("array " + array + ": " + counted(tasks.size(), "task") + " with " + counted(trials, "trial"));
    next_poll_ = std::max(next_poll_, Clock::now() + queue_poll());
    last_running_ = Clock::now();
  }

  Batch of(const SlurmTask& task) const {
    Batch batch{{}, o_.karst, o_.folder / "flying", o_.timeout_s};
    for (const std::size_t i : task.trials) batch.trials.push_back(jobs_[i]);
    return batch;
  }

  /// Only arrays with tasks under way need to be cancelled by a later start.
  void note_arrays() {
    std::set<std::string> now = tasks_.arrays();
    if (now == arrays_) return;
    arrays_ = std::move(now);
    note(arrays_, o_);
  }

  void tell() {
    const std::size_t running = tasks_.running(), waiting = tasks_.waiting();
    const std::string why = tasks_.why_waiting();
    if (events_.queue)
      events_.queue(counted(running, "task") + (running == 1 ? " runs, " : " run, ") +
                    std::to_string(waiting) + (waiting == 1 ? " waits" : " wait") +
                    (why.empty() || running > 0 ? "" : " (" + why + ")"));
    if (events_.tick) events_.tick(running);
    if (running > 0 || waiting == 0) last_running_ = Clock::now();
    if (Clock::now() - last_running_ < kSilence || said_why_ == why) return;
    said_why_ = why;
    say("no task runs, " + counted(waiting, "task") + (waiting == 1 ? " waits" : " wait") +
        (why.empty() ? "" : "; Slurm's reason: " + why));
  }

  Clock::duration queue_poll() const {
    return std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(kLooksAPoll * o_.look_s));
  }
  void say(const std::string& text) const {
    if (events_.say) events_.say("slurm: " + text);
  }

  const std::vector<TrialJob>& jobs_;
  const SlurmOptions& o_;
  const ExecutorEvents& events_;
  SlurmTasks tasks_;
  std::set<std::string> arrays_;
  std::size_t submissions_ = 0;
  bool is_mute_ = false;
  std::optional<std::string> said_why_;
  Clock::time_point next_poll_ = Clock::now() + queue_poll(), next_submission_{},
                    last_running_ = Clock::now();
};

}  // namespace

std::size_t batch_size(double expected_trial_s) {
  return static_cast<std::size_t>(std::clamp(std::ceil(kTask_s / expected_trial_s), 1.0, 1000.0));
}

bool run_on_slurm(const std::vector<TrialJob>& jobs, const SlurmOptions& o, const ExecutorEvents& events) {
  if (const std::set<std::string> arrays = left_behind(o); !arrays.empty()) {
    if (events.say) events.say("slurm: cancels what an earlier start left");
    cancel_arrays(arrays, events.say);
    note({}, o);
  }
  std::error_code ignored;
  fs::remove_all(o.folder / "flying", ignored);
  fs::remove_all(batches(o), ignored);
  Submission submission(jobs, o, events);
  try {
    if (submission.fly()) return true;
    submission.cancel();
    return false;
  } catch (...) {  // the disk is full, a program was changed ...: nothing of it must go on flying
    try {
      submission.cancel();
    } catch (const InputError&) {  // the first reason counts; the next start cancels
    }
    throw;
  }
}

}  // namespace karst::campaign
