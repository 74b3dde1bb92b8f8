// The pings that were sent and not answered yet: only an echo of one of them is an answer.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

#include "core_stack/common/time.h"

namespace karst::socket {

class OutstandingPings {
 public:
  /// A ping went out at `sent` by the core's clock. The oldest of more than 64 is given up: at ten a second
  /// its answer would be six seconds late.
  void note(core::TimeNs sent) { sent_[next_++ % sent_.size()] = sent; }
  /// Whether a ping was sent then, and its answer is the first one.
  bool answered(core::TimeNs sent) {
    const auto found = std::find(sent_.begin(), sent_.end(), sent);
    if (sent == kNone || found == sent_.end()) return false;
    *found = kNone;
    return true;
  }
  void clear() { sent_.fill(kNone); }

 private:
  static constexpr core::TimeNs kNone = -1;
  std::array<core::TimeNs, 64> sent_ = filled();
  std::size_t next_ = 0;

  static constexpr std::array<core::TimeNs, 64> filled() {
    std::array<core::TimeNs, 64> all{};
    all.fill(kNone);
    return all;
  }
};

}  // namespace karst::socket
