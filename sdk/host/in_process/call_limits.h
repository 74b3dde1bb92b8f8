// The time that one call of a policy may take before the policy is abandoned.
#pragma once
#include <string>

namespace karst::host {

/// Processor time does not count while other programs run, so a loaded machine does not end a policy. The
/// wall clock limit is for calls that wait for ever.
struct CallLimits {
  double wall_s = 60, cpu_s = 10;
};

/// "did not return within 60 s", "took more than 10 s of processor time"; "" if neither limit is exceeded.
std::string passed(const CallLimits& limits, double wall_s, double cpu_s);

}  // namespace karst::host
