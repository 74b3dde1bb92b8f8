// What one call of a policy may cost before it is given up.
#pragma once
#include <string>

namespace karst::host {

/// Processor time does not run while other programs have the machine, so that a loaded machine costs no
/// policy its flight. The wall clock is for what waits for ever.
struct CallLimits {
  double wall_s = 60, cpu_s = 10;
};

/// "did not return within 60 s", "took more than 10 s of processor time"; "" while neither limit is passed.
std::string passed(const CallLimits& limits, double wall_s, double cpu_s);

}  // namespace karst::host
