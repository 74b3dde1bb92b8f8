#include "sdk/host/isolation/policy_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <utility>

#include "core_stack/common/error.h"
#include "sdk/host/isolation/descriptor.h"
#include "sdk/host/isolation/file_access.h"
#include "sdk/host/isolation/policy_child.h"
#include "sdk/host/isolation/process.h"

namespace karst::host {
namespace {

constexpr std::size_t kMaxThreads = 64;

/// A duplicate with a number far above those that the child gets.
int raised(int descriptor) {
  const int duplicate = fcntl(descriptor, F_DUPFD_CLOEXEC, 100);
  if (duplicate < 0)
    throw core::InputError("a policy's process", "",
                           std::string("no descriptor can be had for it: ") + std::strerror(errno));
  return duplicate;
}

/// What the process gets of the host: the ends of the rings, and where it prints (-1: nowhere).
struct Inherited {
  int requests, answers, output;
};

void print_to(posix_spawn_file_actions_t& files, int output) {
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    if (output < 0)
      posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_WRONLY, 0);
    else
      posix_spawn_file_actions_adddup2(&files, output, stream);
}

pid_t spawn(const std::string& program, const Inherited& given) {
  const Descriptor read_end(raised(given.requests)), write_end(raised(given.answers)),
      output(given.output < 0 ? -1 : raised(given.output));
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  print_to(files, output.value);
  posix_spawn_file_actions_adddup2(&files, read_end.value, kRequestsDescriptor);
  posix_spawn_file_actions_adddup2(&files, write_end.value, kAnswersDescriptor);
  posix_spawn_file_actions_addclosefrom_np(&files, kAnswersDescriptor + 1);
  // A separate process group: Ctrl-C on a terminal ends the mission in order, not the policy first.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, static_cast<short>(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF |
                                                           POSIX_SPAWN_SETPGROUP));
  const std::string host = std::to_string(getpid());
  char* const argv[] = {const_cast<char*>(program.c_str()), const_cast<char*>(host.c_str()),  // NOLINT
                        nullptr};
  pid_t id = -1;
  const int code = posix_spawn(&id, program.c_str(), &files, &attributes, argv, environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (code != 0)
    throw core::InputError(program, "", std::string("cannot be run for the policy: ") + std::strerror(code));
  return id;
}

/// Number of threads, from the link count of /proc/PID/task; 0 if the process is gone.
std::size_t threads_of(pid_t id) {
  struct stat s {};
  const std::string path = "/proc/" + std::to_string(id) + "/task";
  return stat(path.c_str(), &s) == 0 && s.st_nlink > 2 ? s.st_nlink - 2 : 0;
}

}  // namespace

std::string policy_child_program() {
  const auto self = std::filesystem::read_symlink("/proc/self/exe");
  return (self.parent_path().parent_path() / "lib/karst/karst-policy-child").string();
}

StartingThread::StartingThread(const std::function<pid_t()>& start) {
  const auto started = std::make_shared<std::promise<pid_t>>();
  thread_ = std::thread([started, start, released = release_.get_future()] {
    try {
      started->set_value(start());
    } catch (...) {
      started->set_exception(std::current_exception());
    }
    released.wait();
  });
  try {
    process_ = started->get_future().get();
  } catch (...) {
    end();
    throw;
  }
}

StartingThread::~StartingThread() { end(); }

void StartingThread::end() {
  release_.set_value();
  thread_.join();
}

PolicyProcess::PolicyProcess(const std::string& program, CallLimits limits,
                             std::shared_ptr<PolicyOutput> output)
    : limits_(limits), ring_(ours_, theirs_, [this] { watch(); }) {
  const Descriptor requests(ours_.read_only_descriptor());
  if (output) drain_.emplace(std::move(output));
  if (landlock_version() == 0) hide_this_process();
  const Inherited given{requests.value, theirs_.descriptor(), drain_ ? drain_->write_end() : -1};
  started_by_.emplace([&] { return spawn(program, given); });
  id_ = started_by_->process();
  if (drain_) drain_->close_write_end();
  ours_.close_descriptor();
  theirs_.close_descriptor();
}

PolicyProcess::~PolicyProcess() {
  if (id_ > 0) end_process(id_);
}

double PolicyProcess::cpu_s() const {
  clockid_t clock{};
  timespec t{};
  if (id_ <= 0 || clock_getcpuclockid(id_, &clock) != 0 || clock_gettime(clock, &t) != 0)
    return cpu_before_s_;
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void PolicyProcess::begin_call(const char* name) {
  call_ = name;
  call_began_ = std::chrono::steady_clock::now();
  cpu_before_s_ = cpu_s();
  if (cpu_after_s_)
    if (const std::string which = passed(limits_, 0, cpu_before_s_ - *cpu_after_s_); !which.empty())
      throw ProcessBroken("its process " + which + " between two calls");
  // The kernel's own limit backs up watch(); a process may ignore its signal.
  rlimit cpu{};
  if (id_ <= 0 || prlimit(id_, RLIMIT_CPU, nullptr, &cpu) != 0) return;
  cpu.rlim_cur =
      static_cast<rlim_t>(std::ceil(cpu_before_s_ + std::max(0.0, limits_.cpu_s - spent_cpu_s_)) + 1);
  prlimit(id_, RLIMIT_CPU, &cpu, nullptr);
}

void PolicyProcess::end_call() {
  spent_wall_s_ += waited_s();
  cpu_after_s_ = cpu_s();
  spent_cpu_s_ += *cpu_after_s_ - cpu_before_s_;
}

double PolicyProcess::waited_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - call_began_).count();
}

void PolicyProcess::watch() {
  if (id_ <= 0) throw ProcessBroken("its process has ended");
  int status = 0;
  const pid_t changed = waitpid(id_, &status, WNOHANG | WUNTRACED);
  const std::string in_call = std::string(" in ") + call_ + "()";
  if (changed == id_ && WIFSTOPPED(status)) throw ProcessBroken("its process stopped itself" + in_call);
  if (changed != 0) {
    id_ = -1;
    ProcessEnd end;
    end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    throw ProcessBroken("its process ended" + in_call + ": " + describe(end));
  }
  const std::string which =
      passed(limits_, spent_wall_s_ + waited_s(), spent_cpu_s_ + cpu_s() - cpu_before_s_);
  if (!which.empty()) throw ProcessBroken(std::string(call_) + "() " + which);
  if (threads_of(id_) > kMaxThreads)
    throw ProcessBroken("it ran more than " + std::to_string(kMaxThreads) + " threads" + in_call);
}

void PolicyProcess::send(std::uint32_t kind, std::span<const std::byte> body) {
  try {
    ring_.send(kind, body);
  } catch (const RingBroken& e) {
    throw ProcessBroken(std::string("garbage came from its process in ") + call_ + "(): " + e.what());
  }
}

RingMessage PolicyProcess::receive(std::size_t max_bytes) {
  try {
    return ring_.receive(max_bytes);
  } catch (const RingBroken& e) {
    throw ProcessBroken(std::string("garbage came from its process in ") + call_ + "(): " + e.what());
  }
}

void PolicyProcess::expect_end() noexcept {
  for (int i = 0; i < 200 && id_ > 0; ++i) {
    if (waitpid(id_, nullptr, WNOHANG) == id_)
      id_ = -1;
    else
      usleep(5000);
  }
}

}  // namespace karst::host
