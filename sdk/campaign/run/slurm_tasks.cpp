#include "sdk/campaign/run/slurm_tasks.h"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <utility>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using core::counted;
using core::InputError;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestWord = 300;

/// Names in a folder. A cached listing of a shared disk is renewed when the folder is opened, and one call
/// tells of all trials in it.
std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code ignored;
  for (auto at = fs::directory_iterator(folder, ignored); at != fs::directory_iterator();
       at.increment(ignored)) {
    names.insert(at->path().filename().string());
    if (ignored) break;
  }
  return names;
}

std::string label(const TaskId& id) { return id.first + "_" + std::to_string(id.second); }

void record_lost(const TrialJob& job, const std::string& how) {
  fs::remove_all(job.run_dir);  // what another build flew there is no part of this result
  fs::create_directories(job.run_dir);
  std::ofstream(job.run_dir / kLogFile)
      << "its Slurm task ended without it, " << kAttempts << " times: " << how << "\n";
  write_note(job.run_dir, {{0, SIGKILL, false, 0}, "slurm", job.identity});
}

}  // namespace

std::string last_line(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return "";
  std::ifstream in = core::open_input(file, core::kMaxDataFileBytes);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  return last.substr(0, kLongestWord);
}

void SlurmTasks::plan(std::size_t batch) {
  SlurmTask task;
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    if (is_flown(jobs_[i])) {  // before the cancellation of an earlier start
      if (events_.ended) events_.ended(i, read_note(jobs_[i].run_dir).end);
      continue;
    }
    task.trials.push_back(i);
    if (task.trials.size() == batch) todo_.push_back(std::exchange(task, {}));
  }
  if (!task.trials.empty()) todo_.push_back(task);
}

std::vector<SlurmTask> SlurmTasks::next(std::size_t most) const {
  return {todo_.begin(), todo_.begin() + static_cast<std::ptrdiff_t>(std::min(most, todo_.size()))};
}

void SlurmTasks::submitted(const std::vector<SlurmTask>& tasks) {
  todo_.erase(todo_.begin(), todo_.begin() + static_cast<std::ptrdiff_t>(tasks.size()));
  flying_.insert(flying_.end(), tasks.begin(), tasks.end());
}

void SlurmTasks::take(const TaskStates& states) {
  std::map<std::string, std::size_t> begun_again;  // tasks by the node that they were on
  for (SlurmTask& task : flying_) {
    const auto found = states.find(task.id);
    if (found == states.end()) {  // over, or just submitted; how it was last is still worth telling
      if (task.is_known && !task.last.is_over()) task.last = {"", task.last.node, "", 0, 0, 0};
      continue;
    }
    if (task.is_known && found->second.restarts > task.last.restarts) ++begun_again[task.last.node];
    const std::string node = task.last.node;
    task.last = found->second;
    if (task.last.node.empty() && task.last.restarts > 0) task.last.node = node;
    task.is_known = true;
  }
  for (const auto& [id, state] : states)
    if (state.state == "COMPLETED") good_nodes_.insert(state.node);
  for (const auto& [node, tasks] : begun_again)
    say((node.empty() ? "a node" : node) + " was lost or taken away: " + counted(tasks, "task") +
        (tasks == 1 ? " starts again" : " start again"));
}

void SlurmTasks::settle(bool states_are_new) {
  std::map<fs::path, std::set<std::string>> seen;
  for (SlurmTask& task : flying_) {
    if (!task.last.node.empty() || !task.is_known || task.last.is_over())  // others have not begun
      std::erase_if(task.trials, [&](std::size_t i) {
        const fs::path& dir = jobs_[i].run_dir;
        const auto [folder, is_new] = seen.try_emplace(dir.parent_path());
        if (is_new) folder->second = names_in(dir.parent_path());
        if (!folder->second.contains(dir.filename().string()) || !is_flown(jobs_[i])) return false;
        if (events_.ended) events_.ended(i, read_note(dir).end);
        return true;
      });
    if (!task.trials.empty() && states_are_new && task.last.is_over()) give_up(task);
  }
  std::erase_if(flying_, [](const SlurmTask& t) { return t.trials.empty(); });
}

void SlurmTasks::give_up(SlurmTask& task) {
  if (task.last.state == "COMPLETED" || task.last.state.empty()) {  // then they may be seen later here
    if (task.over == Clock::time_point{}) task.over = Clock::now();
    if (std::chrono::duration<double>(Clock::now() - task.over).count() < late_s_) return;
  }
  if (task.last.state == "CANCELLED")
    throw InputError("slurm", "task " + label(task.id),
                     "was cancelled by somebody; the same command goes on where it was");
  if (task.last.gave_up()) nodes_of_failures_.insert(task.last.node);
  if (task.last.is_innocent()) {
    if (task.attempt >= kAttempts) {
      const std::string said = last_line(task.log);
      throw InputError("slurm", "task " + label(task.id),
                       "could not fly its trials, which says nothing about them: " + task.last.text() +
                           (said.empty() ? "" : "; it said last: " + said) + "; its output is " +
                           task.log.string());
    }
  }
  fly_again_or_lose(task);
}

void SlurmTasks::fly_again_or_lose(SlurmTask& task) {
  const std::string how = task.last.text();
  say("task " + label(task.id) + " ended without " + counted(task.trials.size(), "trial") + " (" + how +
      "), " +
      (task.attempt < kAttempts ? "which will be flown again" : "for the second time: recorded as failed"));
  for (const std::size_t i : task.trials) {
    losses_[i] += (losses_[i].empty() ? "" : ", then ") + how;
    if (task.attempt < kAttempts) {
      todo_.push_back({{i}, task.attempt + 1, {}, {}, {}, false, {}});  // one each: none takes others with it
    } else {
      record_lost(jobs_[i], losses_[i]);
      if (events_.ended) events_.ended(i, read_note(jobs_[i].run_dir).end);
    }
  }
  task.trials.clear();
}

std::size_t SlurmTasks::running() const {
  return static_cast<std::size_t>(std::count_if(flying_.begin(), flying_.end(), [](const SlurmTask& t) {
    return t.is_known && t.last.state != "PENDING" && !t.last.is_over();
  }));
}

std::string SlurmTasks::why_waiting() const {
  for (const SlurmTask& t : flying_)
    if (t.last.state == "PENDING" && t.last.reason != "None" && t.last.reason != "Priority")
      return t.last.reason;
  return "";
}

std::set<std::string> SlurmTasks::arrays() const {
  std::set<std::string> arrays;
  for (const SlurmTask& t : flying_) arrays.insert(t.id.first);
  return arrays;
}

std::string SlurmTasks::bad_nodes() const {
  std::string bad;
  if (!good_nodes_.empty())
    for (const std::string& node : nodes_of_failures_)
      if (!good_nodes_.contains(node) && !node.empty()) bad += (bad.empty() ? "" : ",") + node;
  return bad;
}

}  // namespace karst::campaign
