#include "sdk/flight/real_time.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <set>
#include <thread>

#include "core_stack/common/error.h"
#include "sdk/flight/service_manager.h"

namespace karst::flight {
namespace {

TEST(Cpus, AListHoldsNumbersAndRanges) {
  EXPECT_EQ(cpus_of("", "m"), std::vector<int>{});
  EXPECT_EQ(cpus_of("3", "m"), std::vector{3});
  EXPECT_EQ(cpus_of("0,2-4,7", "m"), (std::vector{0, 2, 3, 4, 7}));
}

TEST(Cpus, WhatIsNoListIsRefusedWithItsPlace) {
  for (const char* bad :
       {"a", "1,", ",1", "1-", "-1", "3-1", "1 2", "1--2", "99999", "1-2-3", "99999999999999999999"}) {
    try {
      cpus_of(bad, "mission.info");
      FAIL() << bad;
    } catch (const core::InputError& e) {
      EXPECT_NE(std::string(e.what()).find("mission.info"), std::string::npos);
      EXPECT_NE(std::string(e.what()).find("real_time.job_cpus"), std::string::npos) << e.what();
    }
  }
}

TEST(ThreadRoles, TheOrderIsWatchdogLoopLocalizationAndAUsualThreadStarvesNoPolicy) {
  using enum ThreadRole;
  int last = 50;  // the kernel's interrupt threads
  for (const ThreadRole role : {watchdog, loop, localization}) {
    EXPECT_LT(priority_of(role), last) << core::name_of(role);
    last = priority_of(role);
  }
  EXPECT_GE(last, 1) << "above every usual thread";
  for (const ThreadRole role : {sensing, map, pictures, registration}) EXPECT_EQ(priority_of(role), 0);
  std::set<ThreadRole> of_lanes;
  for (const auto& [lane, name] : core::names_of(core::Lane{})) {
    of_lanes.insert(role_of(lane));
    EXPECT_STREQ(core::name_of(role_of(lane)), name);
  }
  EXPECT_EQ(of_lanes.size(), 5u);
}

/// Whether this machine allows it or not: what is said is what holds.
TEST(RealTimeProcess, AThreadHasThePriorityThatThePageSays) {
  RealTimeOptions options;
  options.lock_memory = false;
  const RealTimeProcess process(options, "m");
  bool granted = false;
  for (const Grant& g : process.grants())
    if (g.what == "priorities") granted = g.granted;
  std::thread([&] {
    process.prepare_thread(ThreadRole::localization);
    sched_param param{};
    const int policy = sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
    sched_getparam(0, &param);
    EXPECT_EQ(policy, granted ? SCHED_FIFO : SCHED_OTHER);
    EXPECT_EQ(param.sched_priority, granted ? priority_of(ThreadRole::localization) : 0);
    std::thread([] { EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER) << "what it starts has none"; }).join();
    EXPECT_TRUE(process.release_thread());
    EXPECT_EQ(sched_getscheduler(0) & ~SCHED_RESET_ON_FORK, SCHED_OTHER);
  }).join();
  EXPECT_EQ(sched_getscheduler(0) & ~SCHED_RESET_ON_FORK, SCHED_OTHER) << "trying leaves nothing behind";
}

TEST(RealTimeProcess, WhatIsNotAskedForIsNotTakenAndSaid) {
  RealTimeOptions options;
  options.priorities = options.lock_memory = false;
  const RealTimeProcess process(options, "m");
  process.prepare_thread(ThreadRole::loop);
  EXPECT_EQ(sched_getscheduler(0) & ~SCHED_RESET_ON_FORK, SCHED_OTHER);
  EXPECT_NE(process.page().find("not asked for (real_time.priorities)"), std::string::npos);
  EXPECT_NE(process.page().find("not asked for (real_time.lock_memory)"), std::string::npos);
}

TEST(RealTimeProcess, AProcessorThatIsNotThereIsANoteAndNoError) {
  RealTimeOptions options;
  options.priorities = options.lock_memory = false;
  options.job_cpus = "1000";
  const RealTimeProcess process(options, "m");
  EXPECT_NE(process.page().find("may not use 1000"), std::string::npos) << process.page();
}

TEST(RealTimeProcess, WithAffinityTheJobsRunWhereTheyWereAsked) {
  RealTimeOptions options;
  options.priorities = options.lock_memory = false;
  cpu_set_t allowed;
  sched_getaffinity(0, sizeof allowed, &allowed);
  int cpu = 0;
  while (!CPU_ISSET(cpu, &allowed)) ++cpu;
  options.job_cpus = std::to_string(cpu);
  const RealTimeProcess process(options, "m");
  std::thread([&] {
    cpu_set_t after;
    process.prepare_thread(ThreadRole::map);
    sched_getaffinity(0, sizeof after, &after);
    EXPECT_EQ(CPU_COUNT(&after), 1);
    EXPECT_TRUE(CPU_ISSET(cpu, &after));
  }).join();
}

/// A socket as systemd listens on, with an abstract name.
class Listener {
 public:
  Listener() : name_("@karst-test-" + std::to_string(getpid())), socket_(socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name_.copy(address.sun_path, sizeof address.sun_path);
    address.sun_path[0] = '\0';
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address),
                   static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name_.size())),
              0);
  }
  ~Listener() { close(socket_); }
  const std::string& name() const { return name_; }
  std::string receive() {
    char buffer[256];
    const ssize_t n = recv(socket_, buffer, sizeof buffer, 0);
    return n < 0 ? "" : std::string(buffer, static_cast<std::size_t>(n));
  }

 private:
  std::string name_;
  int socket_;
};

TEST(ServiceManager, SendsTheStateAsOneDatagram) {
  Listener systemd;
  const ServiceManager manager(systemd.name(), std::chrono::microseconds(0));
  EXPECT_TRUE(manager.listens());
  manager.notify("READY=1\nSTATUS=flying");
  EXPECT_EQ(systemd.receive(), "READY=1\nSTATUS=flying");
}

TEST(ServiceManager, WithoutOneNothingHappens) {
  const ServiceManager none("", std::chrono::microseconds(5));
  EXPECT_FALSE(none.listens());
  EXPECT_EQ(none.watchdog().count(), 0);
  none.notify("READY=1");
  ServiceManager("/nowhere/to/be/found", std::chrono::microseconds(0)).notify("READY=1");
  ServiceManager("/" + std::string(500, 'x'), std::chrono::microseconds(0)).notify("READY=1");
}

TEST(ServiceWatchdog, GivesSignsOfLifeOnlyWhileThereIsLife) {
  Listener systemd;
  const ServiceManager manager(systemd.name(), std::chrono::milliseconds(2));
  std::atomic<int> asked = 0;
  {
    const ServiceWatchdog watchdog(manager, [&] { return ++asked <= 3; });
    while (asked < 6) std::this_thread::yield();
  }
  manager.notify("end");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(systemd.receive(), "WATCHDOG=1");
  EXPECT_EQ(systemd.receive(), "end");
}

}  // namespace
}  // namespace karst::flight
