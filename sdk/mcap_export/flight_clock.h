// The stamps of an exported flight.
#pragma once
#include <algorithm>
#include <cstdint>

#include "core_stack/common/time.h"
#include "sdk/mcap_export/ros_messages.h"

namespace karst::mcap {

/// Flight time as time since 1970: `epoch` is when the flight began.
struct FlightClock {
  core::TimeNs epoch = 0;

  /// Never before 1970, which neither ROS nor MCAP can say.
  std::uint64_t ns(double flight_s) const {
    return static_cast<std::uint64_t>(std::max<core::TimeNs>(0, epoch + core::from_seconds(flight_s)));
  }
  ros::Time stamp(double flight_s) const {
    const std::uint64_t t = ns(flight_s);
    return {static_cast<std::int32_t>(t / core::kSecond), static_cast<std::uint32_t>(t % core::kSecond)};
  }
};

}  // namespace karst::mcap
