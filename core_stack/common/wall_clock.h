// The machine's clock, as a flight in real time reads it and waits for it. Tests give another.
#pragma once
#include "core_stack/common/time.h"

namespace karst::core {

class WallClock {
 public:
  virtual ~WallClock() = default;
  /// Monotonic, from any origin.
  virtual TimeNs now() const = 0;
  /// Returns at `time` or later; at once if that is past.
  virtual void sleep_until(TimeNs time) const = 0;
};

/// CLOCK_MONOTONIC.
const WallClock& machine_clock();

}  // namespace karst::core
