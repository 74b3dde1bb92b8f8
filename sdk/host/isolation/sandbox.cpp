#include "sdk/host/isolation/sandbox.h"

#include <fcntl.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string>

#include "core_stack/common/error.h"
#include "core_stack/common/sanitized.h"
#include "sdk/host/isolation/file_access.h"

namespace karst::host {
namespace {

[[noreturn]] void cannot(const std::string& what, int error) {
  throw core::InputError("a policy's process", "", what + ": " + std::strerror(error));
}

void limit(__rlimit_resource resource, rlim_t value, const char* what) {
  rlimit now{};
  // A lower limit of the user's own (ulimit) stays: nobody but root may raise it.
  if (getrlimit(resource, &now) == 0) value = std::min(value, now.rlim_max);
  const rlimit both{value, value};
  if (setrlimit(resource, &both) != 0) cannot(std::string(what) + " cannot be limited", errno);
}

/// Allowed with any arguments. Calls that this kernel's headers do not know do not exist for libseccomp
/// either and are skipped.
constexpr const char* kAllowed[] = {
    // memory
    "mmap", "munmap", "mprotect", "mremap", "madvise", "mincore", "brk", "membarrier",
    // threads and waiting
    "futex", "futex_waitv", "sched_yield", "sched_getaffinity", "sched_getparam", "sched_getscheduler",
    "sched_get_priority_max", "sched_get_priority_min", "nanosleep", "clock_nanosleep", "poll", "ppoll",
    "set_robust_list", "get_robust_list", "rseq", "set_tid_address", "restart_syscall", "exit", "exit_group",
    "gettid", "getcpu",
    // clocks, ids and working directory
    "clock_gettime", "clock_getres", "gettimeofday", "time", "times", "getrusage", "getpid", "getppid",
    "getuid", "geteuid", "getgid", "getegid", "uname", "sysinfo", "getrlimit", "getrandom", "getcwd",
    "arch_prctl",
    // open files, and querying others
    "read", "readv", "pread64", "preadv", "write", "writev", "close", "lseek", "fstat", "stat", "lstat",
    "newfstatat", "fstatat64", "statx", "fstatfs", "statfs", "access", "faccessat", "faccessat2", "readlink",
    "readlinkat", "getdents64", "fadvise64",
    // its own signals
    "rt_sigaction", "rt_sigprocmask", "rt_sigreturn", "rt_sigpending", "sigaltstack"};

class Filter {
 public:
  Filter() : context_(seccomp_init(SCMP_ACT_ERRNO(EPERM)), &seccomp_release) {
    if (!context_) cannot("system calls cannot be filtered", ENOMEM);
    // Calls of another architecture (x32, i386): the default ends the thread that made one, and only that.
    const int code = seccomp_attr_set(context_.get(), SCMP_FLTATR_ACT_BADARCH, SCMP_ACT_KILL_PROCESS);
    if (code != 0) cannot("calls of other architectures cannot be filtered", -code);
  }
  template <class... Comparisons>
  void rule(std::uint32_t action, const char* name, Comparisons... when) {
    const int call = seccomp_syscall_resolve_name(name);
    if (call == __NR_SCMP_ERROR || call < 0) return;  // not of this architecture
    const int code = seccomp_rule_add(context_.get(), action, call, sizeof...(when), when...);
    if (code != 0) cannot(std::string("the filter takes no rule for ") + name, -code);
  }
  template <class... Comparisons>
  void allow(const char* name, Comparisons... when) {
    rule(SCMP_ACT_ALLOW, name, when...);
  }
  void load() {
    if (const int code = seccomp_load(context_.get()); code != 0)
      cannot("system calls cannot be filtered on this machine", -code);
  }

 private:
  std::unique_ptr<void, decltype(&seccomp_release)> context_;
};

}  // namespace

void confine_this_process(std::uint64_t memory_limit_bytes,
                          const std::vector<std::filesystem::path>& readable) {
  if (!kSanitized) limit(RLIMIT_AS, memory_limit_bytes, "memory");
  limit(RLIMIT_CORE, 0, "core dumps");
  limit(RLIMIT_FSIZE, 0, "the size of files");
  limit(RLIMIT_NOFILE, 64, "open files");
  read_only_from(readable);

  Filter filter;
  for (const char* name : kAllowed) filter.allow(name);
  constexpr scmp_datum_t writing = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND;
  filter.allow("open", SCMP_A1(SCMP_CMP_MASKED_EQ, writing, O_RDONLY));
  filter.allow("openat", SCMP_A2(SCMP_CMP_MASKED_EQ, writing, O_RDONLY));
  filter.allow("clone", SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD));
  filter.rule(SCMP_ACT_ERRNO(ENOSYS), "clone3");  // its flags cannot be filtered: libraries then use clone
  filter.allow("tgkill", SCMP_A0(SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid())));  // abort() and raise()
  filter.allow("prlimit64", SCMP_A2(SCMP_CMP_EQ, 0));                                 // read only
  filter.allow("prctl", SCMP_A0(SCMP_CMP_EQ, PR_SET_NAME));
  for (const int command : {F_GETFD, F_SETFD, F_GETFL})
    filter.allow("fcntl", SCMP_A1(SCMP_CMP_EQ, static_cast<scmp_datum_t>(command)));
  filter.load();
}

}  // namespace karst::host
