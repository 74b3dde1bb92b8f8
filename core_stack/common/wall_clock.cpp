#include "core_stack/common/wall_clock.h"

#include <cerrno>
#include <ctime>

namespace karst::core {
namespace {

class MachineClock final : public WallClock {
 public:
  TimeNs now() const override {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return TimeNs{t.tv_sec} * kSecond + t.tv_nsec;
  }
  /// Until an absolute time: what passes between reading the clock and sleeping makes it no longer.
  void sleep_until(TimeNs time) const override {
    const timespec t{time / kSecond, time % kSecond};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
    }
  }
};

}  // namespace

const WallClock& machine_clock() {
  static const MachineClock clock;
  return clock;
}

}  // namespace karst::core
