// When a sensor's stamp was, by the mission's clock.
//
// Without synchronization the two clocks differ by an unknown offset, and drift by some 50 ppm. A packet
// arrives after it was stamped, with a delay that varies and is never negative. The least delay of many
// packets is nearly that of an idle line, so
//
//   offset = min (arrival - stamp)
//
// over the last 5 to 10 s: long enough to meet an idle line, short enough that the drift is below 0.5 ms.
// What is left is the constant part of the delay. A synchronized sensor (PTP) has the host's clock, up to a
// constant such as the leap seconds.
#pragma once
#include <optional>

#include "core_stack/common/time.h"

namespace karst::lidar {

class SensorClock {
 public:
  /// A packet that ends with the sensor's stamp `sensor_ns` has arrived by `now`, mission time.
  void observe(std::int64_t sensor_ns, core::TimeNs now);
  /// Mission time of a stamp; none before the first packet. Never later than the arrival of a packet that was
  /// observed with that stamp.
  std::optional<core::TimeNs> at(std::int64_t sensor_ns) const;

 private:
  void restart(std::int64_t offset, core::TimeNs now);

  std::optional<std::int64_t> current_, previous_;  // least offsets of two windows
  core::TimeNs window_begin_ = 0;
  std::int64_t jump_ = 0;  // the offset that the last packets asked for instead, and how many of them
  int jumps_ = 0;
};

/// The same for a sensor whose clock is the host's plus `ahead_ns`: `host_ns` is the host's clock at `now`.
inline core::TimeNs synchronized_at(std::int64_t sensor_ns, std::int64_t ahead_ns, std::int64_t host_ns,
                                    core::TimeNs now) {
  return now - (host_ns - (sensor_ns - ahead_ns));
}

}  // namespace karst::lidar
