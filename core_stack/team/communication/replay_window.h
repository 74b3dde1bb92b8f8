// Anti-replay window: which frames of one sender were received already (as in IPsec; RFC 4303,
// section 3.4.3). Tolerates loss, reordering, and a sender that restarts its count at 0.
#pragma once
#include <cstdint>
#include <optional>

#include "core_stack/common/time.h"

namespace karst::core {

class ReplayWindow {
 public:
  enum class Verdict { newest, late, refused };

  /// `sent` is the sender's time, `sequence` counts its frames. A frame up to 63 behind the newest is
  /// accepted once.
  Verdict take(TimeNs sent, std::uint16_t sequence) {
    if (!sent_) {
      sent_ = sent;
      sequence_ = sequence;
      heard_ = 1;
      return Verdict::newest;
    }
    const int ahead = static_cast<std::int16_t>(sequence - sequence_);
    if (sent > *sent_ || (sent == *sent_ && ahead > 0)) {
      // Newer by time, but not by number: the sender restarted its count.
      heard_ = ahead <= 0 ? ~std::uint64_t{0} : ahead < kBits ? heard_ << ahead | 1 : 1;
      sent_ = sent;
      sequence_ = sequence;
      return Verdict::newest;
    }
    if (ahead > 0 || ahead <= -kBits || heard_ >> -ahead & 1) return Verdict::refused;
    heard_ |= std::uint64_t{1} << -ahead;
    return Verdict::late;
  }

 private:
  static constexpr int kBits = 64;
  std::optional<TimeNs> sent_;  // of the newest
  std::uint16_t sequence_ = 0;
  std::uint64_t heard_ = 0;  // bit i: number sequence_ - i was received, or is no longer accepted
};

}  // namespace karst::core
