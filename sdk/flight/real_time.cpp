#include "sdk/flight/real_time.h"

#include <linux/capability.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

#include "core_stack/common/error.h"

namespace karst::flight {
namespace {

constexpr std::array kPriorities = {45, 40, 30, 0, 0, 0, 0};  // by role; 0: a usual thread
constexpr std::size_t kStackBytes = 512 * 1024;  // of the loop's thread, touched before the flight

/// 0, or the reason why not.
int set_fifo(int priority) {
  const sched_param param{.sched_priority = priority};
  return sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &param) == 0 ? 0 : errno;
}

/// 0, or the reason why not. The flag stays: to clear it needs CAP_SYS_NICE.
int set_usual() {
  const sched_param param{};
  return sched_setscheduler(0, SCHED_OTHER | SCHED_RESET_ON_FORK, &param) == 0 ? 0 : errno;
}

bool may_lock_any_memory() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, 2> data{};
  if (syscall(SYS_capget, &header, data.data()) != 0) return false;
  return (data[0].effective >> CAP_IPC_LOCK & 1u) != 0;
}

/// Pages of the stack that are touched now are there when a step needs them.
[[gnu::noinline]] void touch_stack() {
  std::array<volatile char, kStackBytes> stack;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  for (std::size_t i = 0; i < stack.size(); i += page) stack[i] = 0;
}

std::string kernel_text() {
  utsname name{};
  uname(&name);
  int real_time = 0;
  std::ifstream("/sys/kernel/realtime") >> real_time;
  return std::string(name.sysname) + " " + name.release +
         (real_time == 1 ? ", PREEMPT_RT" : ", without PREEMPT_RT");
}

std::string list_of(const cpu_set_t& set) {
  std::string text;
  for (int i = 0; i < CPU_SETSIZE; ++i)
    if (CPU_ISSET(i, &set)) text += (text.empty() ? "" : ",") + std::to_string(i);
  return text;
}

}  // namespace

std::vector<int> cpus_of(const std::string& list, const std::string& file) {
  std::vector<int> cpus;
  const auto fail = [&] {
    throw core::InputError(file, "real_time.job_cpus",
                           "expected numbers of processors such as 1-3 or 0,2, got \"" + list + "\"");
  };
  const char *at = list.data(), *const end = at + list.size();
  const auto number = [&] {
    int n = 0;
    const auto [next, error] = std::from_chars(at, end, n);
    if (error != std::errc() || n < 0 || n >= CPU_SETSIZE) fail();
    at = next;
    return n;
  };
  while (at != end) {
    const int first = number();
    int last = first;
    if (at != end && *at == '-') {
      ++at;
      last = number();
    }
    if (last < first) fail();
    for (int cpu = first; cpu <= last; ++cpu) cpus.push_back(cpu);
    if (at == end) break;
    if (*at++ != ',' || at == end) fail();
  }
  return cpus;
}

int priority_of(ThreadRole role) { return kPriorities[static_cast<std::size_t>(role)]; }

ThreadRole role_of(core::Lane lane) {
  switch (lane) {
    case core::Lane::sensing:
      return ThreadRole::sensing;
    case core::Lane::localization:
      return ThreadRole::localization;
    case core::Lane::map:
      return ThreadRole::map;
    case core::Lane::pictures:
      return ThreadRole::pictures;
    case core::Lane::registration:
      break;
  }
  return ThreadRole::registration;
}

RealTimeProcess::RealTimeProcess(const RealTimeOptions& options, const std::string& mission_file)
    : options_(options) {
  sched_getaffinity(0, sizeof all_cpus_, &all_cpus_);
  grants_.push_back({"kernel", true, kernel_text()});
  grants_.push_back(choose_cpus(mission_file));
  grants_.push_back(try_priorities());
  grants_.push_back(lock_memory());
}

RealTimeProcess::~RealTimeProcess() {
  if (has_locked_) munlockall();
}

/// All or none: some without the others would turn the order around.
Grant RealTimeProcess::try_priorities() {
  if (!options_.priorities) return {"priorities", false, "not asked for (real_time.priorities)"};
  for (const int priority : kPriorities) {
    const int error = priority == 0 ? 0 : set_fifo(priority);
    if (error == 0) continue;
    set_usual();
    return {"priorities", false,
            std::string("not granted (") + std::strerror(error) + "): all threads are equal; rtprio " +
                std::to_string(kPriorities.front()) +
                " in limits.conf, or LimitRTPRIO in the unit, allows them"};
  }
  if (const int error = set_usual(); error != 0)
    return {"priorities", false,
            std::string("not used, as they cannot be given back: ") + std::strerror(error)};
  has_priorities_ = true;
  std::string text = "SCHED_FIFO:";
  for (const auto& [role, name] : names_of(ThreadRole{}))
    if (priority_of(role) > 0)
      text += std::string(role == ThreadRole::watchdog ? " " : ", ") + name + " " +
              std::to_string(priority_of(role));
  return {"priorities", true, text};
}

/// With a limit, memory that is asked for in flight would be refused once the limit is reached.
Grant RealTimeProcess::lock_memory() {
  if (!options_.lock_memory) return {"memory", false, "not asked for (real_time.lock_memory)"};
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_cur != RLIM_INFINITY && !may_lock_any_memory())
    return {
        "memory", false,
        "not locked, as only " + std::to_string(limit.rlim_cur / 1024) +
            " KiB may be: memlock unlimited in limits.conf, or LimitMEMLOCK=infinity in the unit, allows it"};
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    return {"memory", false, std::string("not locked: ") + std::strerror(errno)};
  has_locked_ = true;
  mallopt(M_TRIM_THRESHOLD, -1);  // what was freed stays, and so need not be faulted in again
  touch_stack();
  return {"memory", true, "locked, what comes later too; stack touched"};
}

Grant RealTimeProcess::choose_cpus(const std::string& mission_file) {
  loop_cpus_ = job_cpus_ = all_cpus_;
  const std::vector<int> jobs = cpus_of(options_.job_cpus, mission_file);
  std::string missing;
  const auto choose = [&](const std::vector<int>& wanted, cpu_set_t& into) {
    if (wanted.empty()) return;
    cpu_set_t chosen;
    CPU_ZERO(&chosen);
    for (const int cpu : wanted) {
      if (CPU_ISSET(cpu, &all_cpus_))
        CPU_SET(cpu, &chosen);
      else
        missing += (missing.empty() ? "" : ", ") + std::to_string(cpu);
    }
    if (CPU_COUNT(&chosen) > 0) into = chosen;
  };
  if (options_.loop_cpu >= 0) choose({static_cast<int>(options_.loop_cpu)}, loop_cpus_);
  choose(jobs, job_cpus_);
  const std::string text = CPU_EQUAL(&loop_cpus_, &all_cpus_) && CPU_EQUAL(&job_cpus_, &all_cpus_)
                               ? "any of " + list_of(all_cpus_)
                               : "loop on " + list_of(loop_cpus_) + ", jobs on " + list_of(job_cpus_);
  return {"processors", missing.empty(),
          text + (missing.empty() ? "" : "; this process may not use " + missing)};
}

void RealTimeProcess::prepare_thread(ThreadRole role) const {
  if (has_priorities_ && priority_of(role) > 0) set_fifo(priority_of(role));
  const bool is_job = role != ThreadRole::loop && role != ThreadRole::watchdog;
  const cpu_set_t& cpus = is_job ? job_cpus_ : role == ThreadRole::loop ? loop_cpus_ : all_cpus_;
  if (!CPU_EQUAL(&cpus, &all_cpus_)) sched_setaffinity(0, sizeof cpus, &cpus);
  if (role == ThreadRole::loop) {
    prctl(PR_SET_TIMERSLACK, 1UL);  // ns; the default of 50 us applies to threads without priority
    if (has_locked_) touch_stack();
  }
}

bool RealTimeProcess::release_thread() const {
  const bool is_usual = !has_priorities_ || set_usual() == 0;
  return sched_setaffinity(0, sizeof all_cpus_, &all_cpus_) == 0 && is_usual;
}

std::string RealTimeProcess::page() const {
  std::string text;
  for (const Grant& g : grants_) {
    std::string name = g.what;
    name.resize(12, ' ');
    text += "  " + name + " " + g.text + "\n";
  }
  return text;
}

}  // namespace karst::flight
