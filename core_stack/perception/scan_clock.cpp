#include "core_stack/perception/scan_clock.h"

#include <algorithm>
#include <cstdlib>

namespace karst::core {
namespace {

/// Corrections that differ by less are the same: scans do not always take equally long to come.
constexpr TimeNs kJitter = 30 * kMillisecond;

}  // namespace

/// The least: what comes later than usual has waited somewhere.
TimeNs ScanClock::usual_lag() const { return *std::min_element(lags_.begin(), lags_.end()); }

/// The correction by which a scan that comes `now` would lag behind as others do.
TimeNs ScanClock::needed(TimeNs stamp, TimeNs now) const {
  const TimeNs correction = now - usual_lag() - stamp;
  const bool right_again = std::abs(correction) < kJitter && stamp <= now;
  return right_again ? 0 : correction;
}

std::optional<TimeNs> ScanClock::taken_at(TimeNs stamp, TimeNs now) {
  const auto possible = [&](TimeNs taken) { return taken <= now && (!last_ || taken > *last_); };
  if (!possible(stamp + correction_) && lags_.empty()) return std::nullopt;
  if (!possible(stamp + correction_) || asked_for_) {
    const TimeNs asks = needed(stamp, now);
    const bool confirmed = asked_for_ && std::abs(asks - *asked_for_) < kJitter;
    if (confirmed && possible(stamp + asks)) correction_ = asks;
    asked_for_ = asks;
    if (!possible(stamp + correction_)) return std::nullopt;
  }
  asked_for_.reset();
  const TimeNs taken = stamp + correction_;
  lags_.push_back(now - taken);
  last_ = taken;
  return taken;
}

}  // namespace karst::core
