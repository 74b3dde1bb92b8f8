// What a person sees while a mission flies: one line that renews itself on a terminal, a line every half
// minute of flight elsewhere.
#pragma once
#include "core_stack/mission/mission_control.h"

namespace karst::tools {

class StatusLine {
 public:
  explicit StatusLine(bool quiet);
  void show(const core::MissionStatus& status);
  void end();

 private:
  bool quiet_, terminal_;
};

}  // namespace karst::tools
