#include "sdk/flight/status_line.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <mutex>
#include <string>
#include <utility>

#include "core_stack/common/format_text.h"
#include "core_stack/common/printable.h"
#include "sdk/terminal/terminal.h"

namespace karst::flight {
namespace {

constexpr core::TimeNs kLineEvery = 30 * core::kSecond;

void print_text(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

/// As wide as the figures, to keep what follows in its place.
std::string battery_text(const std::optional<core::BatteryStatus>& battery) {
  if (!battery) return "unknown           ";
  constexpr double kMost_s = 100 * 60 - 1;  // on the ground it may be without end
  const int left_s = static_cast<int>(std::clamp(battery->seconds_left, 0.0, kMost_s));
  return core::format_text("%3.0f %% (%2d:%02d left)", 100 * battery->fraction_left, left_s / 60,
                           left_s % 60);
}

void show_team(core::TimeNs now, const std::vector<core::MissionStatus>& vehicles) {
  if (now % kLineEvery != 0) return;
  std::string line = std::to_string(now / core::kSecond) + " s:";
  for (std::size_t i = 0; i < vehicles.size(); ++i)
    line += "  " + std::to_string(i + 1) + " " + core::name_of(vehicles[i].phase);
  print_error("%s\n", line.c_str());
}

}  // namespace

StatusLine::StatusLine(std::size_t vehicles, core::Clock clock)
    : renews_(vehicles == 1 && isatty(STDERR_FILENO) != 0) {
  if (clock == core::Clock::real_time) printer_ = std::thread([this] { print_all(); });
}

StatusLine::~StatusLine() { end(); }

void StatusLine::print_all() {
  for (bool last = false; !last;) {
    std::string reason, text;
    {
      const std::lock_guard lock(mutex_);
      wake_.wait(mutex_, [this] { return over_ || !next_.empty() || !reason_.empty(); });
      last = over_;
      reason = std::exchange(reason_, {});
      text = std::exchange(next_, {});
    }
    print_text(reason + text);
  }
}

void StatusLine::show(core::TimeNs now, const std::vector<core::MissionStatus>& vehicles) {
  if (vehicles.size() == 1)
    show_alone(vehicles.front());
  else
    show_team(now, vehicles);
}

void StatusLine::print(std::string reason, std::string status) {
  if (!printer_.joinable()) return print_text(reason + status);
  {
    const std::lock_guard lock(mutex_);
    if (!reason.empty()) reason_ = std::move(reason);
    if (!status.empty()) next_ = std::move(status);
  }
  wake_.notify_one();
}

void StatusLine::show_alone(const core::MissionStatus& s) {
  const char* erase = renews_ ? "\r\033[K" : "";
  std::string reason;
  if (s.waits_for != waits_for_ && !s.waits_for.empty()) reason = erase + core::printable(s.waits_for) + "\n";
  waits_for_ = s.waits_for;
  if (!renews_ && s.time % kLineEvery != 0) {
    if (!reason.empty()) print(std::move(reason), "");
    return;
  }
  const int t = static_cast<int>(core::seconds(s.time));
  std::array<char, 512> text;
  std::snprintf(text.data(), text.size(), "%s%-8s %2d:%02d  battery %s  %6.0f m³  %4.1f m/s  %.60s%s", erase,
                core::name_of(s.phase), t / 60, t % 60, battery_text(s.battery).c_str(), s.explored_m3,
                s.speed_mps, core::printable(s.waits_for.empty() ? s.goal : s.waits_for).c_str(),
                renews_ ? "" : "\n");
  print(std::move(reason), text.data());
}

void StatusLine::end() {
  if (printer_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    wake_.notify_one();
    printer_.join();
  }
  if (renews_) std::fprintf(stderr, "\r\033[K");
}

}  // namespace karst::flight
