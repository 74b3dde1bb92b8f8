// Child processes: programs that must not outlive this one, and may crash or hang.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace karst::host {

/// How a process ended.
struct ProcessEnd {
  int exit_code = 0;  // if no signal ended it
  int signal = 0;     // signal that ended it; 0: it exited
  bool hung = false;  // it was ended because it took too long
  double wall_s = 0;
};

/// Runs argv[0] with both outputs going to `log` and an empty input, in a separate process group, so that
/// Ctrl-C on a terminal does not reach it. The kernel ends it when this thread's process ends, for whatever
/// reason. Throws core::InputError if no process can be created; exit code 127 means that the program could
/// not be run.
pid_t start_process(const std::vector<std::string>& argv, const std::filesystem::path& log);

/// Fills `end` and returns true if the process has ended.
bool has_ended(pid_t pid, ProcessEnd& end);

/// Kills a process and its process group at once, and waits for it.
void end_process(pid_t pid);

struct ProcessOutput {
  ProcessEnd end;
  std::string out;  // both outputs
};
/// Runs a program to its end, for at most `limit_s`.
ProcessOutput run_process(const std::vector<std::string>& argv, double limit_s);

/// "killed by signal 11 (Segmentation fault)", "exit code 3".
std::string describe(const ProcessEnd& end);

}  // namespace karst::host
