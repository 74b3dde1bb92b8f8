#include "sdk/flight/status_line.h"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <mutex>
#include <string>
#include <utility>

#include "core_stack/common/printable.h"
#include "sdk/terminal/terminal.h"

namespace karst::flight {
namespace {

constexpr core::TimeNs kLineEvery = 30 * core::kSecond;

void print_text(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
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
    std::string text;
    {
      const std::lock_guard lock(mutex_);
      wake_.wait(mutex_, [this] { return over_ || !next_.empty(); });
      last = over_;
      text = std::exchange(next_, {});
    }
    print_text(text);
  }
}

void StatusLine::show(core::TimeNs now, const std::vector<core::MissionStatus>& vehicles) {
  if (vehicles.size() == 1)
    show_alone(vehicles.front());
  else
    show_team(now, vehicles);
}

void StatusLine::show_alone(const core::MissionStatus& s) {
  if (!renews_ && s.time % kLineEvery != 0) return;
  const int t = static_cast<int>(core::seconds(s.time));
  std::array<char, 512> text;
  std::snprintf(text.data(), text.size(),
                "%s%-8s %2d:%02d  battery %3.0f %% (%2d:%02d left)  %6.0f m³  %4.1f m/s  %.60s%s",
                renews_ ? "\r\033[K" : "", core::name_of(s.phase), t / 60, t % 60, 100 * s.battery_fraction,
                static_cast<int>(s.battery_seconds_left) / 60, static_cast<int>(s.battery_seconds_left) % 60,
                s.explored_m3, s.speed_mps, core::printable(s.goal).c_str(), renews_ ? "" : "\n");
  if (!printer_.joinable()) return print_text(text.data());
  {
    const std::lock_guard lock(mutex_);
    next_ = text.data();
  }
  wake_.notify_one();
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
