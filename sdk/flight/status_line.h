// What a person sees while a mission flies: of one vehicle a line that renews itself on a terminal, elsewhere
// a line every half minute of flight; of a team a line every half minute.
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

  bool renews_;  // itself, on a terminal
};

}  // namespace karst::flight
