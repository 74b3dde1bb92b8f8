#include "sdk/campaign/run/slurm_queue.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <thread>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/program_in_path.h"
#include "sdk/host/isolation/process.h"

namespace karst::campaign {
namespace {

using core::InputError;
using host::ProcessOutput;
using host::run_process;
using Clock = std::chrono::steady_clock;

constexpr double kCommand_s = 120;  // time limit of a Slurm command
constexpr auto kCancelled = std::chrono::seconds(60);
constexpr const char* kForgotten = "Invalid job id";  // Slurm forgets a task minutes after its end
constexpr const char* kFormat =
    "ArrayJobID:20|,ArrayTaskID:12|,State:20|,exit_code:12|,RestartCnt:8|,NodeList:64|,Reason:40|";

std::string slurm_program(const std::string& name) {
  if (auto program = core::program_in_path(name)) return *program;
  throw InputError("slurm", name, "is not installed here, or not in PATH");
}

bool failed(const ProcessOutput& o) { return o.end.hung || o.end.signal != 0 || o.end.exit_code != 0; }

std::string without_blanks(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text.substr(std::min(text.find_first_not_of(' '), text.size()));
}

/// `env -u` for each variable by which a user filters what squeue prints, such as SQUEUE_PARTITION.
std::vector<std::string> without_own_settings() {
  std::vector<std::string> argv{slurm_program("env")};
  for (char** variable = environ; *variable; ++variable)
    if (const std::string_view v = *variable; v.starts_with("SQUEUE_"))
      argv.insert(argv.end(), {"-u", std::string(v.substr(0, v.find('=')))});
  return argv;
}

InputError complaint(const std::string& name, const ProcessOutput& output) {
  const std::string said = without_blanks(output.out);
  return InputError("slurm", name, describe(output.end) + (said.empty() ? "" : ": " + said));
}

std::string joined(const std::set<std::string>& arrays) {
  std::string all;
  for (const std::string& a : arrays) all += (all.empty() ? "" : ",") + a;
  return all;
}

}  // namespace

bool TaskState::is_over() const {
  constexpr auto kOver =
      std::to_array<std::string_view>({"BOOT_FAIL", "CANCELLED", "COMPLETED", "DEADLINE", "FAILED",
                                       "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", "REVOKED", "TIMEOUT", ""});
  return std::find(kOver.begin(), kOver.end(), state) != kOver.end();
}

bool TaskState::gave_up() const {
  constexpr int kNotLaunched = 53;  // what Slurm gives as the signal, such as where a folder is missing
  return state == "BOOT_FAIL" ||
         (state == "FAILED" && (signal == 0 || signal == kNotLaunched || reason == "JobLaunchFailure"));
}

bool TaskState::is_innocent() const {
  return gave_up() || state == "NODE_FAIL" || state == "PREEMPTED" || state == "COMPLETED" || state.empty();
}

std::string TaskState::text() const {
  std::string text = state.empty() ? "how is not known any more" : state;
  if (signal != 0) text += " by signal " + std::to_string(signal);
  if (exit_code != 0) text += " with exit code " + std::to_string(exit_code);
  return text + (node.empty() ? "" : " on " + node);
}

TaskStates read_queue(const std::string& printed) {
  TaskStates states;
  std::istringstream lines(printed);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, '|');) cells.push_back(without_blanks(cell));
    if (cells.size() < 7 || cells[1].find_first_not_of("0123456789") != std::string::npos || cells[1].empty())
      continue;
    const int status = std::atoi(cells[3].c_str());  // as of waitpid()
    states[{cells[0], std::strtoull(cells[1].c_str(), nullptr, 10)}] = {
        cells[2], cells[5], cells[6], std::atoi(cells[4].c_str()), status >> 8, status & 0x7f};
  }
  return states;
}

std::optional<TaskStates> ask_queue(const std::set<std::string>& arrays) {
  if (arrays.empty()) return TaskStates{};
  std::vector<std::string> argv = without_own_settings();
  argv.insert(argv.end(), {slurm_program("squeue"), "--noheader", "--array", "--states=all",
                           "--jobs=" + joined(arrays), std::string("--Format=") + kFormat});
  const ProcessOutput queue = run_process(argv, kCommand_s);
  const bool forgotten = queue.out.find(kForgotten) != std::string::npos;
  if (failed(queue) && !forgotten) return std::nullopt;
  TaskStates states = read_queue(queue.out);
  if (states.empty() && !forgotten && !without_blanks(queue.out).empty())
    throw InputError("slurm", "squeue", "its answer is not understood: " + without_blanks(queue.out));
  return states;
}

std::string submit_array(const std::vector<std::string>& sbatch_arguments) {
  std::vector<std::string> argv{slurm_program("sbatch")};
  argv.insert(argv.end(), sbatch_arguments.begin(), sbatch_arguments.end());
  const ProcessOutput output = run_process(argv, kCommand_s);
  if (failed(output)) throw complaint("sbatch", output);
  const std::string printed = without_blanks(output.out);
  const std::string last =
      printed.substr(printed.rfind('\n') == std::string::npos ? 0 : printed.rfind('\n') + 1);
  return last.substr(0, last.find(';'));  // "12;cluster" where there are several
}

bool may_pass(const std::string& error) {
  for (const char* passing :
       {"Unable to contact slurm controller", "Socket timed out", "Slurm temporarily unable",
        "QOSMaxSubmitJob", "AssocMaxSubmitJob", "Job violates accounting/QOS policy", "hung: not done"})
    if (error.find(passing) != std::string::npos) return true;
  return false;
}

void cancel_arrays(const std::set<std::string>& arrays, const std::function<void(const std::string&)>& say) {
  if (arrays.empty()) return;
  std::vector<std::string> argv{slurm_program("scancel"), "--quiet"};
  argv.insert(argv.end(), arrays.begin(), arrays.end());
  const ProcessOutput output = run_process(argv, kCommand_s);
  if (failed(output) && output.out.find(kForgotten) == std::string::npos) throw complaint("scancel", output);
  for (const auto begin = Clock::now();; std::this_thread::sleep_for(std::chrono::milliseconds(500))) {
    const std::optional<TaskStates> states = ask_queue(arrays);
    std::set<std::string> nodes;
    std::size_t left = 0;
    if (states)
      for (const auto& [id, s] : *states)
        if (!s.is_over()) {
          ++left;
          if (!s.node.empty()) nodes.insert(s.node);
        }
    if (states && left == 0) return;
    if (Clock::now() - begin < kCancelled) continue;
    if (say)
      say(states ? "slurm: " + core::counted(left, "cancelled task") + " of " + joined(arrays) +
                       " did not end within a minute" + (nodes.empty() ? "" : ", on " + joined(nodes)) +
                       "; goes on without waiting"
                 : "slurm: squeue does not answer; goes on without waiting for the cancelled tasks");
    return;
  }
}

}  // namespace karst::campaign
