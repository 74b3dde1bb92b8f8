// What a flight in real time asks of the computer: priorities, locked memory, processors. What is not granted
// costs punctuality, never the flight, and page() says so.
#pragma once
#include <sched.h>

#include <string>
#include <vector>

#include "core_stack/common/executive.h"
#include "sdk/flight/real_time_options.h"

namespace karst::flight {

/// Highest priority first. The watchdog must see a loop that spins. All are below 50, the priority of the
/// kernel's interrupt threads with PREEMPT_RT, which bring the vehicle's messages. From sensing on they are
/// usual threads: with a priority they would starve a policy in a process of its own, which has none.
enum class ThreadRole { watchdog, loop, localization, sensing, map, pictures, registration };
constexpr auto names_of(ThreadRole) {
  using enum ThreadRole;
  return std::to_array<core::Named<ThreadRole>>({{watchdog, "watchdog"},
                                                 {loop, "loop"},
                                                 {localization, "localization"},
                                                 {sensing, "sensing"},
                                                 {map, "map"},
                                                 {pictures, "pictures"},
                                                 {registration, "registration"}});
}
int priority_of(ThreadRole role);  // 0: a usual thread
ThreadRole role_of(core::Lane lane);

/// What was asked for, and what came of it.
struct Grant {
  std::string what;  // "priorities"
  bool granted = false;
  std::string text;  // what holds now; if it is not granted, why, and how to get it
};

class RealTimeProcess {
 public:
  /// Tries priorities on the calling thread, and locks the memory of the process. Throws core::InputError
  /// only for a list of processors that is none.
  RealTimeProcess(const RealTimeOptions& options, const std::string& mission_file);
  ~RealTimeProcess();
  RealTimeProcess(const RealTimeProcess&) = delete;
  RealTimeProcess& operator=(const RealTimeProcess&) = delete;

  /// Gives the calling thread its priority and processors, as far as they were granted. What it starts later
  /// has neither. From any thread.
  void prepare_thread(ThreadRole role) const;
  /// The calling thread becomes a usual one again: evaluating a flight is no real-time work. False if
  /// the kernel refuses.
  bool release_thread() const;

  const std::vector<Grant>& grants() const { return grants_; }
  std::string page() const;

 private:
  Grant try_priorities();
  Grant lock_memory();
  Grant choose_cpus(const std::string& mission_file);

  RealTimeOptions options_;
  bool has_priorities_ = false, has_locked_ = false;
  cpu_set_t all_cpus_{}, loop_cpus_{}, job_cpus_{};
  std::vector<Grant> grants_;
};

}  // namespace karst::flight
