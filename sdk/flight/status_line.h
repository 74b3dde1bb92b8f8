// Status output during a flight: for one vehicle a line that is updated on a terminal, elsewhere a new line
// every half minute of flight; for a team a new line every half minute.
#pragma once
#include <vector>

#include "core_stack/mission/mission_control.h"

namespace karst::flight {

class StatusLine {
 public:
  explicit StatusLine(std::size_t vehicles);
  void show(core::TimeNs now, const std::vector<core::MissionStatus>& vehicles) const;
  void end() const;

 private:
  void show_alone(const core::MissionStatus& status) const;

  bool renews_;  // updates one line, on a terminal
};

}  // namespace karst::flight
