// Judges the stamps of a topic by the times at which its messages were recorded.
#pragma once
#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core_stack/common/time.h"

namespace karst::replay {

/// A stamp that jumps against the time of recording is that of a damaged message, unless several jump in a
/// row: then the sensor's clock was set. Messages wait until that is known, the first ones of a bag, too.
/// Where a clock was set back, its later stamps are shifted, so that time goes on.
template <class Value>
class StampCheck {
 public:
  static constexpr core::TimeNs kMaxJump = 10 * core::kSecond;
  static constexpr std::size_t kJumpsAccepted = 5;

  struct Stamped {
    Value value;
    core::TimeNs stamp = 0, recorded = 0;
  };
  struct Verdict {
    std::vector<Stamped> passed;  // their stamps shifted
    std::vector<Stamped> refused;
    core::TimeNs set_by = 0;  // by which the clock was just found to be set; 0: it was not
  };

  /// `other_shift`: that of another topic, which is taken where it is the same but for the latency of
  /// recording.
  Verdict take(Stamped message, core::TimeNs other_shift = 0) {
    const core::TimeNs offset = offset_of(message);
    if (offset_ && !is_jump(offset, *offset_)) {
      Verdict verdict{{}, std::exchange(waiting_, {}), 0};
      offset_ = offset;
      pass(std::move(message), verdict);
      return verdict;
    }
    // Those that jumped elsewhere are no witnesses of the same clock.
    Verdict verdict;
    if (offset_) {
      const auto elsewhere = std::stable_partition(
          waiting_.begin(), waiting_.end(), [&](const Stamped& w) { return !is_jump(offset_of(w), offset); });
      std::move(elsewhere, waiting_.end(), std::back_inserter(verdict.refused));
      waiting_.erase(elsewhere, waiting_.end());
    }
    waiting_.push_back(std::move(message));
    if (waiting_.size() < kJumpsAccepted) return verdict;
    if (!offset_) return finish();
    const core::TimeNs jump = minus(median_offset(), *offset_);
    verdict.set_by = jump;
    if (jump < 0) {
      const core::TimeNs shift = minus(shift_, jump);
      shift_ = std::abs(minus(shift, other_shift)) < core::kSecond ? other_shift : shift;
    }
    for (Stamped& w : std::exchange(waiting_, {})) {
      offset_ = offset_of(w);
      pass(std::move(w), verdict);
    }
    return verdict;
  }

  /// At the end of the bag.
  Verdict finish() {
    Verdict verdict;
    if (!offset_ && !waiting_.empty()) {
      const core::TimeNs usual = median_offset();
      offset_ = usual;
      for (Stamped& w : std::exchange(waiting_, {})) {
        if (is_jump(offset_of(w), usual))
          verdict.refused.push_back(std::move(w));
        else
          pass(std::move(w), verdict);
      }
    }
    std::move(waiting_.begin(), waiting_.end(), std::back_inserter(verdict.refused));
    waiting_.clear();
    return verdict;
  }

  core::TimeNs shift() const { return shift_; }

 private:
  // Damaged stamps and times lie anywhere within 64 bits.
  static core::TimeNs minus(core::TimeNs a, core::TimeNs b) {
    core::TimeNs difference = 0;
    constexpr core::TimeNs kMost = std::numeric_limits<core::TimeNs>::max();
    if (__builtin_sub_overflow(a, b, &difference)) return a < b ? -kMost : kMost;
    return std::max(difference, -kMost);
  }
  static bool is_jump(core::TimeNs a, core::TimeNs b) { return std::abs(minus(a, b)) > kMaxJump; }
  core::TimeNs shifted(core::TimeNs stamp) const { return minus(stamp, -shift_); }
  core::TimeNs offset_of(const Stamped& m) const { return minus(shifted(m.stamp), m.recorded); }
  core::TimeNs median_offset() const {
    std::vector<core::TimeNs> offsets;
    for (const Stamped& w : waiting_) offsets.push_back(offset_of(w));
    const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
    std::nth_element(offsets.begin(), middle, offsets.end());
    return *middle;
  }
  void pass(Stamped message, Verdict& verdict) {
    message.stamp = shifted(message.stamp);
    verdict.passed.push_back(std::move(message));
  }

  std::optional<core::TimeNs> offset_;  // of shifted stamps, against the times of recording
  core::TimeNs shift_ = 0;
  std::vector<Stamped> waiting_;
};

}  // namespace karst::replay
