#include "plugins/socket/clock_offset.h"

#include <algorithm>

#include "plugins/socket/messages.h"

namespace karst::socket {

using core::TimeNs;

namespace {

constexpr TimeNs kJump = 50 * core::kMillisecond;
constexpr TimeNs kSlewDivisor = 100;
constexpr double kDrift = 15e-6;  // of a clock, as in NTP

}  // namespace

void ClockOffset::add(const RoundTrip& t) {
  for (const TimeNs time : {t.sent, t.answered, t.peer_received, t.peer_sent})
    if (!is_plausible_time(time)) return;
  const TimeNs delay = (t.answered - t.sent) - (t.peer_sent - t.peer_received);
  if (t.answered < t.sent || t.peer_sent < t.peer_received || delay < 0) return;
  const TimeNs out = t.peer_received - t.sent, back = t.peer_sent - t.answered;
  const Sample sample{out + (back - out) / 2, delay, t.answered};
  // Each is right within half of its delay, and clocks drift by far less than 50 ms meanwhile.
  if (count_ > 0 && std::abs(sample.offset - best().offset) > (sample.delay + best().delay) / 2 + kJump)
    forget();
  samples_[count_ % samples_.size()] = sample;
  ++count_;
}

const ClockOffset::Sample& ClockOffset::best() const {
  const auto end = samples_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, samples_.size()));
  return *std::min_element(samples_.begin(), end,
                           [](const Sample& a, const Sample& b) { return a.delay < b.delay; });
}

TimeNs ClockOffset::offset(TimeNs now) {
  if (!known()) return 0;
  const TimeNs wrong = best().offset - offset_;
  const TimeNs most = settled_ ? std::max<TimeNs>(0, now - moved_at_) / kSlewDivisor : std::abs(wrong);
  offset_ += std::abs(wrong) > kJump ? wrong : std::clamp(wrong, -most, most);
  moved_at_ = std::max(moved_at_, now);
  settled_ = true;
  return offset_;
}

TimeNs ClockOffset::error_bound(TimeNs now) const {
  if (!known()) return 0;
  const Sample& b = best();
  return b.delay / 2 + static_cast<TimeNs>(kDrift * static_cast<double>(std::max<TimeNs>(0, now - b.at)));
}

}  // namespace karst::socket
