#include "sdk/host/in_process/call_limits.h"

#include <array>
#include <cstdio>

namespace karst::host {
namespace {

std::string seconds(double s) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%g s", s);
  return text.data();
}

}  // namespace

std::string passed(const CallLimits& limits, double wall_s, double cpu_s) {
  if (cpu_s > limits.cpu_s) return "took more than " + seconds(limits.cpu_s) + " of processor time";
  if (wall_s > limits.wall_s) return "did not return within " + seconds(limits.wall_s);
  return "";
}

}  // namespace karst::host
