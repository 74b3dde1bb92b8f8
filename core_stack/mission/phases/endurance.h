// The remaining flight time.
#pragma once
#include <algorithm>
#include <optional>

#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

class Endurance {
 public:
  explicit Endurance(double max_flight_time_s) : max_flight_time_s_(max_flight_time_s) {}
  void note(const BatteryStatus& battery) { battery_ = battery; }
  /// As the vehicle said last; nothing before its first message.
  const std::optional<BatteryStatus>& battery() const { return battery_; }
  /// As far as the battery limits it: before its first message, it does not.
  double battery_seconds_left() const { return battery_ ? battery_->seconds_left : max_flight_time_s_; }
  /// The flight time allowed counts from `now` on: it waited for a pilot.
  void begin(TimeNs now) { begin_ = now; }
  TimeNs begun() const { return begin_; }
  /// Of the mission's maximum flight time.
  double mission_seconds_left(TimeNs now) const { return max_flight_time_s_ - seconds(now - begin_); }
  /// Limited by the battery and by the mission's maximum flight time.
  double seconds_left(TimeNs now) const {
    return std::min(battery_seconds_left(), mission_seconds_left(now));
  }

 private:
  double max_flight_time_s_;
  TimeNs begin_ = 0;
  std::optional<BatteryStatus> battery_;
};

}  // namespace karst::core
