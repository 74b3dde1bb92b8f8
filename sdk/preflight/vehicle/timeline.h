// Whether the messages of a sensor come regularly, and whether their stamps can be right.
#pragma once
#include <span>
#include <vector>

#include "sdk/preflight/vehicle/vehicle_record.h"

namespace karst::preflight {

struct Timeline {
  int messages = 0;
  double first_after_s = 0;     // from the beginning to the first message
  double rate_hz = 0;           // from the first message on
  double longest_gap_s = 0;     // without a message, up to the end
  double jitter_s = 0;          // 95th percentile of the deviation of stamp intervals from their median
  int backward = 0;             // stamps that are not later than the one before
  double future_s = 0;          // the most by which a stamp was later than its message; 0: none was
  double latency_s = 0;         // from stamp to arrival: median
  double jump_s = 0;            // the greatest lasting change of the latency, with its sign; 0: none found
  std::vector<int> per_second;  // messages in each whole second from the beginning
};

/// Of the messages that came from `begin` to `end`.
Timeline timeline_of(std::span<const Arrival> arrivals, core::TimeNs begin, core::TimeNs end);

}  // namespace karst::preflight
