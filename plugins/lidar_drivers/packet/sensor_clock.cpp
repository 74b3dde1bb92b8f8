#include "plugins/lidar_drivers/packet/sensor_clock.h"

#include <algorithm>
#include <cstdlib>

namespace karst::lidar {
namespace {

constexpr core::TimeNs kWindow = 5 * core::kSecond;
/// A clock that differs by more than this has been set, or the stamp is wrong.
constexpr std::int64_t kJump = core::kSecond / 2;
constexpr int kConfirmed = 20;  // packets that agree on a jump

}  // namespace

void SensorClock::restart(std::int64_t offset, core::TimeNs now) {
  current_ = offset;
  previous_.reset();
  window_begin_ = now;
  jumps_ = 0;
}

void SensorClock::observe(std::int64_t sensor_ns, core::TimeNs now) {
  // Modulo 2^64: a stamp may be any number.
  const auto offset =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(now) - static_cast<std::uint64_t>(sensor_ns));
  const auto apart = [offset](std::int64_t other) {
    return static_cast<std::uint64_t>(offset) - static_cast<std::uint64_t>(other) +
               static_cast<std::uint64_t>(kJump) >
           2 * static_cast<std::uint64_t>(kJump);
  };
  if (!current_) return restart(offset, now);
  if (apart(std::min(*current_, previous_.value_or(*current_)))) {
    jumps_ = jumps_ > 0 && !apart(jump_) ? jumps_ + 1 : 1;
    jump_ = offset;
    if (jumps_ >= kConfirmed) restart(offset, now);
    return;
  }
  jumps_ = 0;
  if (now - window_begin_ >= kWindow) {
    previous_ = current_;
    current_ = offset;
    window_begin_ = now;
  }
  current_ = std::min(*current_, offset);
}

std::optional<core::TimeNs> SensorClock::at(std::int64_t sensor_ns) const {
  if (!current_) return std::nullopt;
  const std::int64_t offset = std::min(*current_, previous_.value_or(*current_));
  return static_cast<core::TimeNs>(static_cast<std::uint64_t>(sensor_ns) +
                                   static_cast<std::uint64_t>(offset));
}

}  // namespace karst::lidar
