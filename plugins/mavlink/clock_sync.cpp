#include "plugins/mavlink/clock_sync.h"

#include <algorithm>

namespace karst::mavlink {
namespace {

using core::TimeNs;

constexpr TimeNs kWindow = 5 * core::kSecond;      // a clock that drifts by 50 ppm: 0.25 ms
constexpr TimeNs kDrift = 2 * core::kMillisecond;  // of a bad clock, in that time
constexpr TimeNs kTooLong = core::kSecond;

}  // namespace

void ClockSync::note_answer(TimeNs asked_at, TimeNs autopilot_time, TimeNs now) {
  // Bytes from a link may say any time: beyond this, 73 years, differences could overflow.
  constexpr TimeNs kFarthest = TimeNs{1} << 61;
  if (std::max({asked_at, autopilot_time}) >= kFarthest || std::min({asked_at, autopilot_time}) <= -kFarthest)
    return;
  const TimeNs round_trip = now - asked_at;
  if (round_trip < 0 || round_trip > kTooLong) return;
  const TimeNs offset = autopilot_time - (asked_at + round_trip / 2);
  // The true offset is within half of each round trip. No room for both: the autopilot started anew.
  if (known() && std::abs(offset - offset_) > (round_trip + round_trip_) / 2 + kDrift) exchanges_.clear();
  while (!exchanges_.empty() && exchanges_.front().at < now - kWindow) exchanges_.pop_front();
  exchanges_.push_back({now, offset, round_trip});
  const auto best = std::min_element(exchanges_.begin(), exchanges_.end(), [](const auto& a, const auto& b) {
    return a.round_trip < b.round_trip;
  });
  offset_ = best->offset;
  round_trip_ = best->round_trip;
}

}  // namespace karst::mavlink
