#include "sdk/host/isolation/process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>

#include "core_stack/common/error.h"

namespace karst::host {
namespace {

using Clock = std::chrono::steady_clock;

/// Runs between fork and exec: makes system calls only.
[[noreturn]] void become(char* const* argv, int log, int nothing, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // the parent ended before the line above
  setpgid(0, 0);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_DFL);
  dup2(nothing, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execv(argv[0], argv);
  const char* text = std::strerror(errno);
  for (const char* part : {"karst: cannot run ", static_cast<const char*>(argv[0]), ": ", text, "\n"})
    if (::write(STDERR_FILENO, part, std::strlen(part)) < 0) break;
  _exit(127);
}

}  // namespace

pid_t start_process(const std::vector<std::string>& argv, const std::filesystem::path& log) {
  std::vector<char*> words;
  for (const std::string& a : argv)
    words.push_back(const_cast<char*>(a.c_str()));  // NOLINT: execv's signature
  words.push_back(nullptr);
  const int out = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  const int error = errno;
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const pid_t parent = getpid();
  const pid_t pid = out < 0 ? -1 : fork();
  if (pid == 0) become(words.data(), out, nothing, parent);
  const int fork_error = errno;
  if (out >= 0) close(out);
  if (nothing >= 0) close(nothing);
  if (out < 0)
    throw core::InputError(log.string(), "", std::string("cannot be written: ") + std::strerror(error));
  if (pid < 0)
    throw core::InputError(argv[0], "",
                           std::string("no process can be made for it: ") + std::strerror(fork_error));
  setpgid(pid, pid);  // in parent and child, since either may run first
  return pid;
}

bool has_ended(pid_t pid, ProcessEnd& end) {
  int status = 0;
  if (waitpid(pid, &status, WNOHANG) != pid) return false;
  end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  return true;
}

void end_process(pid_t pid) {
  kill(-pid, SIGKILL);
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
}

ProcessOutput run_process(const std::vector<std::string>& argv, double limit_s) {
  std::string file = (std::filesystem::temp_directory_path() / "karst-output-XXXXXX").string();
  const int descriptor = mkstemp(file.data());
  if (descriptor < 0) throw core::InputError(file, "", std::strerror(errno));
  close(descriptor);
  ProcessOutput output;
  const auto begin = Clock::now();
  const pid_t pid = start_process(argv, file);
  const auto waited_s = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  while (!has_ended(pid, output.end)) {
    if (waited_s() > limit_s) {
      end_process(pid);
      output.end.hung = true;
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  output.end.wall_s = waited_s();
  std::ifstream in(file, std::ios::binary);
  output.out.assign(std::istreambuf_iterator<char>(in), {});
  std::filesystem::remove(file);
  return output;
}

std::string describe(const ProcessEnd& end) {
  if (end.hung) return "hung: not done after " + std::to_string(static_cast<long>(end.wall_s)) + " s";
  if (end.signal)
    return "killed by signal " + std::to_string(end.signal) + " (" + strsignal(end.signal) + ")";
  return "exit code " + std::to_string(end.exit_code);
}

}  // namespace karst::host
