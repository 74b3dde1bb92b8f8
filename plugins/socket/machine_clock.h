// An executive's time, read between its steps: its now() stands still within a step, and is when the step was
// due.
#pragma once
#include <algorithm>
#include <chrono>

#include "core_stack/common/executive.h"

namespace karst::socket {

class MachineClock {
 public:
  /// To be called in each step, at once: the step that was least late says how the clocks stand. The
  /// difference may grow by 1 us a step, as the executive's clock loses time with a failure.
  void note_step(core::TimeNs executive_now) {
    const core::TimeNs seen = machine() - executive_now;
    begun_ = noted_ ? std::min(begun_ + 1000, seen) : seen;
    noted_ = true;
  }
  core::TimeNs now() const { return machine() - begun_; }

 private:
  static core::TimeNs machine() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
  core::TimeNs begun_ = 0;
  bool noted_ = false;
};

}  // namespace karst::socket
