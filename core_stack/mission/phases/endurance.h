// The remaining flight time.
#pragma once
#include <algorithm>

#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

class Endurance {
 public:
  explicit Endurance(double max_flight_time_s) : max_flight_time_s_(max_flight_time_s) {
    battery_.seconds_left = max_flight_time_s;
  }
  void note(const BatteryStatus& battery) { battery_ = battery; }
  const BatteryStatus& battery() const { return battery_; }
  /// Of the mission's maximum flight time.
  double mission_seconds_left(TimeNs now) const { return max_flight_time_s_ - seconds(now); }
  /// Limited by the battery and by the mission's maximum flight time.
  double seconds_left(TimeNs now) const { return std::min(battery_.seconds_left, mission_seconds_left(now)); }

 private:
  double max_flight_time_s_;
  BatteryStatus battery_;
};

}  // namespace karst::core
