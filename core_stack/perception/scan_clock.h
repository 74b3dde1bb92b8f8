// Whether a scanner's clock can be right, by the order in which its scans come.
//
// A scan comes after it was taken, and after the one before it: a stamp later than now, or not later than the
// last, cannot be right, and the scan is not used. If the next one needs the same correction to lag behind as
// scans usually do, the clock was set, and stamps are corrected by that from then on. A clock that was set
// back by less than the time between two scans is not told from scans that come late; what that makes of
// poses is for the estimate's gate.
#pragma once
#include <boost/circular_buffer.hpp>
#include <optional>

#include "core_stack/common/time.h"

namespace karst::core {

class ScanClock {
 public:
  /// When the scan was taken that came `now`; nothing if that is not known.
  std::optional<TimeNs> taken_at(TimeNs stamp, TimeNs now);
  /// What is added to the stamps.
  TimeNs correction() const { return correction_; }

 private:
  TimeNs usual_lag() const;
  TimeNs needed(TimeNs stamp, TimeNs now) const;

  boost::circular_buffer<TimeNs> lags_{10};  // of the last scans, from when each was taken to when it came
  std::optional<TimeNs> last_;               // when the last one was taken
  TimeNs correction_ = 0;
  std::optional<TimeNs> asked_for_;  // the correction that the last scan needed, if it needed another
};

}  // namespace karst::core
