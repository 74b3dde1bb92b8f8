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
  int signal = 0;     // that ended it; 0: it ended itself
  bool hung = false;  // it was ended because it took too long
  double wall_s = 0;
};

/// Runs argv[0] with both outputs going to `log` and nothing to read, in a process group of its own, so that
/// Ctrl-C on a terminal does not reach it. The kernel ends it when this thread's process dies, however it
/// dies. Throws core::InputError if no process can be made; exit code 127 says that the program could not be
/// run.
pid_t start_process(const std::vector<std::string>& argv, const std::filesystem::path& log);

/// Fills `end` and returns true if the process has ended.
bool has_ended(pid_t pid, ProcessEnd& end);

/// Ends a process with all it started, at once, and waits for it.
void end_process(pid_t pid);

struct ProcessOutput {
  ProcessEnd end;
  std::string out;  // both outputs
};
/// Runs a program to its end, or for `limit_s` at most.
ProcessOutput run_process(const std::vector<std::string>& argv, double limit_s);

/// "killed by signal 11 (Segmentation fault)", "exit code 3".
std::string describe(const ProcessEnd& end);

}  // namespace karst::host
