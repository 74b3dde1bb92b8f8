// Status output during a flight: for one vehicle a line that is updated on a terminal, elsewhere a new line
// every half minute of flight; for a team a new line every half minute.
//
// What the vehicle waits for gets a line of its own, in full, whenever it changes.
//
// In real time a thread of its own prints: a terminal that is stopped (Ctrl-S), or a pipe that nobody reads,
// must not hold up the loop. What is not printed yet when the next comes is left out.
#pragma once
#include <string>
#include <thread>
#include <vector>

#include "core_stack/common/inheriting_mutex.h"
#include "core_stack/mission/mission_control.h"

namespace karst::flight {

class StatusLine {
 public:
  explicit StatusLine(std::size_t vehicles, core::Clock clock = core::Clock::lockstep);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;
  void show(core::TimeNs now, const std::vector<core::MissionStatus>& vehicles);
  /// Waits until what was to be shown is printed.
  void end();

 private:
  void show_alone(const core::MissionStatus& status);
  void print_all();
  void print(std::string reason, std::string status);

  bool renews_;                  // updates one line, on a terminal
  core::InheritingMutex mutex_;  // of what follows
  core::Condition wake_;
  std::string reason_, next_;  // to be printed
  bool over_ = false;
  std::string waits_for_;  // as shown last
  std::thread printer_;    // in real time
};

}  // namespace karst::flight
