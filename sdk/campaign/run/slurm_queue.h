// What is asked of Slurm's commands: to submit arrays of tasks, to cancel them, and how their tasks are.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace karst::campaign {

/// An array's number and the index in it.
using TaskId = std::pair<std::string, std::size_t>;

/// How Slurm says that a task is.
struct TaskState {
  std::string state;  // Slurm's word, such as RUNNING; "" if Slurm does not know the task (any more)
  std::string node, reason;
  int restarts = 0;  // by Slurm itself: the node was lost, or the task gave up its place
  int exit_code = 0, signal = 0;
  bool is_over() const;
  /// The task could not begin, or its program itself gave up; that does not happen because of a trial.
  bool gave_up() const;
  /// How it ended says nothing about its trials: it gave up, lost its node or its place, or ended well.
  bool is_innocent() const;
  /// "OUT_OF_MEMORY on node3"
  std::string text() const;
};

using TaskStates = std::map<TaskId, TaskState>;

/// What `squeue` printed as it is asked here. Lines that are none are skipped.
TaskStates read_queue(const std::string& printed);

/// The tasks of these arrays that Slurm knows; none if the controller does not answer. Throws
/// core::InputError if the answer is not understood.
std::optional<TaskStates> ask_queue(const std::set<std::string>& arrays);

/// Submits an array by `sbatch` and returns its number. Throws core::InputError with what sbatch said.
std::string submit_array(const std::vector<std::string>& sbatch_arguments);

/// Whether this error of submit_array() may pass: the controller restarts, or too many tasks are queued now.
bool may_pass(const std::string& error);

/// Cancels arrays and waits until no task of them runs, at most for a minute: a lost node's tasks end only
/// when Slurm gives it up. What such a task may still write harms nothing (executor.h). `say` gets a sentence
/// if tasks are left.
void cancel_arrays(const std::set<std::string>& arrays, const std::function<void(const std::string&)>& say);

}  // namespace karst::campaign
