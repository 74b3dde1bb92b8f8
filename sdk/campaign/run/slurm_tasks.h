// Which trials each task of Slurm flies, and what becomes of trials whose task ended without them.
#pragma once
#include <chrono>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "sdk/campaign/run/executor.h"
#include "sdk/campaign/run/slurm_queue.h"

namespace karst::campaign {

constexpr int kAttempts = 2;  // tasks that may end without a trial before it counts as killed

/// A task: trials by their index among the jobs, of which those that are not flown yet are kept.
struct SlurmTask {
  std::vector<std::size_t> trials;
  int attempt = 1;
  TaskId id;
  std::filesystem::path log;
  TaskState last;
  bool is_known = false;                         // to Slurm, at some poll
  std::chrono::steady_clock::time_point over{};  // seen over, but its trials not in the folder
};

class SlurmTasks {
 public:
  /// `late_s`: for how long a trial of a task that ended well may stay unseen, on a shared disk that this
  /// machine reads through a cache.
  SlurmTasks(const std::vector<TrialJob>& jobs, const ExecutorEvents& events, double late_s)
      : jobs_(jobs), events_(events), late_s_(late_s) {}

  /// Collects run directories that are there already, and plans tasks of `batch` trials for the others.
  void plan(std::size_t batch);
  /// Tasks to submit, at most so many; they are flying from now on.
  std::vector<SlurmTask> next(std::size_t most) const;
  void submitted(const std::vector<SlurmTask>& tasks);
  /// Takes what Slurm says of the tasks that fly.
  void take(const TaskStates& states);
  /// Collects run directories that have appeared. If `states_are_new`, it then gives up tasks that are over:
  /// their trials fly again, or are recorded as lost. Throws core::InputError for a task that was cancelled,
  /// and if tasks end because of something other than their trials.
  void settle(bool states_are_new);

  bool all() const { return todo_.empty() && flying_.empty(); }
  bool has_todo() const { return !todo_.empty(); }
  std::size_t flying() const { return flying_.size(); }
  std::size_t running() const;
  std::size_t waiting() const { return flying_.size() - running(); }
  std::string why_waiting() const;
  std::set<std::string> arrays() const;  // with tasks that fly
  /// Nodes on which tasks gave up and none has flown a trial, while other nodes do.
  std::string bad_nodes() const;

 private:
  void give_up(SlurmTask& task);
  void fly_again_or_lose(SlurmTask& task);
  void say(const std::string& text) const {
    if (events_.say) events_.say("slurm: " + text);
  }

  const std::vector<TrialJob>& jobs_;
  const ExecutorEvents& events_;
  double late_s_;
  std::deque<SlurmTask> todo_;
  std::vector<SlurmTask> flying_;
  std::map<std::size_t, std::string> losses_;  // of a trial: how its tasks ended
  std::set<std::string> good_nodes_, nodes_of_failures_;
};

/// Last line of a file that is not empty.
std::string last_line(const std::filesystem::path& file);

}  // namespace karst::campaign
