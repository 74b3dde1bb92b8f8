// The autopilot's clock by TIMESYNC: a question that left at t1 and was answered by the autopilot at its time
// a comes back at t2. The autopilot's clock is then ahead by a - (t1 + t2) / 2, wrong by half of what the two
// ways differ. Of the last seconds the exchange that was quickest is believed: it waited least (NTP's clock
// filter, RFC 5905, section 10).
#pragma once
#include <boost/circular_buffer.hpp>

#include "core_stack/common/time.h"

namespace karst::mavlink {

class ClockSync {
 public:
  /// Ignores what cannot be: an answer from the future, or one that took a second. An answer that contradicts
  /// the earlier ones counts alone: the autopilot's clock was set.
  void note_answer(core::TimeNs asked_at, core::TimeNs autopilot_time, core::TimeNs now);

  bool known() const { return !exchanges_.empty(); }
  /// Autopilot's time less ours.
  core::TimeNs offset() const { return offset_; }
  core::TimeNs ours(core::TimeNs autopilot_time) const { return autopilot_time - offset_; }
  /// Of the quickest exchange of late, there and back.
  core::TimeNs round_trip() const { return round_trip_; }

 private:
  struct Exchange {
    core::TimeNs at, offset, round_trip;
  };
  boost::circular_buffer<Exchange> exchanges_{64};
  core::TimeNs offset_ = 0, round_trip_ = 0;
};

}  // namespace karst::mavlink
