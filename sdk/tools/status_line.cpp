#include "sdk/tools/status_line.h"

#include <unistd.h>

#include <cstdio>

#include "core_stack/common/printable.h"

namespace karst::tools {
namespace {

constexpr core::TimeNs kLineEvery = 30 * core::kSecond;

}  // namespace

StatusLine::StatusLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

void StatusLine::show(const core::MissionStatus& s) {
  if (quiet_ || (!terminal_ && s.time % kLineEvery != 0)) return;
  const int t = static_cast<int>(core::seconds(s.time));
  std::fprintf(stderr, "%s%-8s %2d:%02d  battery %3.0f %% (%2d:%02d left)  %6.0f m^3  %4.1f m/s  %.60s%s",
               terminal_ ? "\r\033[K" : "", core::name_of(s.phase), t / 60, t % 60, 100 * s.battery_fraction,
               static_cast<int>(s.battery_seconds_left) / 60, static_cast<int>(s.battery_seconds_left) % 60,
               s.explored_m3, s.speed_mps, core::printable(s.goal).c_str(), terminal_ ? "" : "\n");
  std::fflush(stderr);
}

void StatusLine::end() {
  if (!quiet_ && terminal_) std::fprintf(stderr, "\r\033[K");
}

}  // namespace karst::tools
