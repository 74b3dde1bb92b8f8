// How long something takes, or how late it is: counts of durations in fixed memory, however long a flight is.
//
// Buckets are linear below 64 ns, and beyond that there are 32 in each octave. A quantile is therefore too
// high by 1/32 (3 %) at most, and never too low.
#pragma once
#include <array>
#include <cstdint>

#include "core_stack/common/time.h"

namespace karst::core {

class DurationHistogram {
 public:
  static constexpr int kLinearBits = 5;  // of the 32 buckets in an octave

  /// A negative duration counts as 0, one beyond 18 minutes as 18 minutes.
  void add(TimeNs duration);

  std::uint64_t count() const { return count_; }
  TimeNs max() const { return max_; }
  TimeNs total() const { return total_; }
  /// The least duration that the share `q` (0 to 1) of all durations does not exceed (nearest rank), rounded
  /// up to the end of its bucket; 0 if there is none.
  TimeNs quantile(double q) const;

 private:
  static constexpr int kMaxBits = 40;
  std::array<std::uint32_t, ((kMaxBits - kLinearBits) << kLinearBits) + (1 << kLinearBits)> counts_{};
  std::uint64_t count_ = 0;
  TimeNs max_ = 0, total_ = 0;
};

}  // namespace karst::core
