// The section `real_time` of a mission: what a flight with --real-time asks of the computer
// (docs/real_time.md).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core_stack/common/options.h"

namespace karst::flight {

struct RealTimeOptions {
  bool priorities = true, lock_memory = true;
  std::int64_t loop_cpu = -1;  // -1: any
  std::string job_cpus;        // "": any
  double hang_limit_s = 2;
};

inline void describe(core::OptionTable& t, RealTimeOptions& o) {
  t.add("priorities", o.priorities,
        "with --real-time: real-time priorities (SCHED_FIFO), where they are allowed");
  t.add("lock_memory", o.lock_memory, "with --real-time: all memory is kept in RAM, where that is allowed");
  t.add("loop_cpu", o.loop_cpu, -1, 1023, "with --real-time: processor of the loop's thread; -1: any");
  t.add("job_cpus", o.job_cpus, {},
        "with --real-time: processors of the lanes' threads, such as 1-3 or 0,2; empty: any");
  t.add("hang_limit", o.hang_limit_s, "s", 0.5, 60,
        "with --real-time: karst ends if the loop hangs for this long, so that the vehicle comes down by "
        "itself");
}

/// Processors of a list such as "0,2-3". Throws core::InputError(file, "real_time.job_cpus", ...).
std::vector<int> cpus_of(const std::string& list, const std::string& file);

}  // namespace karst::flight
