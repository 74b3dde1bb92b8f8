// By how much the vehicle's clock is ahead of the core's, from round trips of pings, as NTP does it (D. L.
// Mills, RFC 5905, sections 8 and 10): of the last eight round trips the one with the least delay counts,
// because delays only ever add to it. The true offset is within half of that delay.
#pragma once
#include <array>
#include <cstddef>

#include "core_stack/common/time.h"

namespace karst::socket {

/// Four times of a ping and its answer.
struct RoundTrip {
  core::TimeNs sent = 0, answered = 0;            // by the core's clock
  core::TimeNs peer_received = 0, peer_sent = 0;  // by the vehicle's clock
};

class ClockOffset {
 public:
  /// Ignores a round trip that ended before it began, or with times that cannot be (kMaxTime). One that
  /// cannot be true together with those before shows that a clock was set: then they are forgotten.
  void add(const RoundTrip& trip);
  /// One of the clocks was set: nothing is known any more.
  void forget() { *this = {}; }
  /// After eight round trips: one that was slow would give a wrong offset first, and the stamps another
  /// order.
  bool known() const { return count_ >= samples_.size(); }
  /// The vehicle's clock minus the core's; 0 if it is not known. Between two round trips it moves slowly, and
  /// only forward in time, so that stamps keep their order: by one part in a hundred of what has passed, but
  /// at once if it is off by more than 50 ms.
  core::TimeNs offset(core::TimeNs now);
  /// Bound of the offset's error: half the delay of the round trip that counts, and 15 ppm of its age.
  core::TimeNs error_bound(core::TimeNs now) const;

 private:
  struct Sample {
    core::TimeNs offset = 0, delay = 0, at = 0;
  };
  const Sample& best() const;
  std::array<Sample, 8> samples_;
  std::size_t count_ = 0;
  core::TimeNs offset_ = 0, moved_at_ = 0;
  bool settled_ = false;
};

}  // namespace karst::socket
