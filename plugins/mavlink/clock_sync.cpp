#include "plugins/mavlink/clock_sync.h"

#include <algorithm>

namespace karst::mavlink {
namespace {

constexpr core::TimeNs kWindow = 5 * core::kSecond;  // a clock that drifts by 50 ppm: 0.25 ms
constexpr core::TimeNs kTooLong = core::kSecond;

}  // namespace

void ClockSync::note_answer(core::TimeNs asked_at, core::TimeNs autopilot_time, core::TimeNs now) {
  // Bytes from a link may say any time: beyond this, 73 years, differences could overflow.
  constexpr core::TimeNs kFarthest = core::TimeNs{1} << 61;
  if (std::max({asked_at, autopilot_time}) >= kFarthest || std::min({asked_at, autopilot_time}) <= -kFarthest)
    return;
  const core::TimeNs round_trip = now - asked_at;
  if (round_trip < 0 || round_trip > kTooLong) return;
  while (!exchanges_.empty() && exchanges_.front().at < now - kWindow) exchanges_.pop_front();
  exchanges_.push_back({now, autopilot_time - (asked_at + round_trip / 2), round_trip});
  const auto best = std::min_element(exchanges_.begin(), exchanges_.end(), [](const auto& a, const auto& b) {
    return a.round_trip < b.round_trip;
  });
  offset_ = best->offset;
  round_trip_ = best->round_trip;
}

}  // namespace karst::mavlink
