#include "core_stack/common/duration_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace karst::core {
namespace {

constexpr int kLinearBits = DurationHistogram::kLinearBits;

/// Bits by which a duration is shortened to get the number of its bucket.
int shift_of(std::uint64_t ns) { return std::max(0, static_cast<int>(std::bit_width(ns)) - kLinearBits - 1); }

std::size_t bucket_of(std::uint64_t ns) {
  const int shift = shift_of(ns);
  return (static_cast<std::size_t>(shift) << kLinearBits) + static_cast<std::size_t>(ns >> shift);
}

/// The greatest duration of a bucket.
TimeNs end_of(std::size_t bucket) {
  const std::size_t octave = bucket >> kLinearBits;
  const int shift = octave < 2 ? 0 : static_cast<int>(octave) - 1;
  const std::uint64_t first = bucket - (static_cast<std::size_t>(shift) << kLinearBits);
  return static_cast<TimeNs>(((first + 1) << shift) - 1);
}

}  // namespace

void DurationHistogram::add(TimeNs duration) {
  const TimeNs ns = std::clamp<TimeNs>(duration, 0, (TimeNs{1} << kMaxBits) - 1);
  ++counts_[bucket_of(static_cast<std::uint64_t>(ns))];
  ++count_;
  max_ = std::max(max_, ns);
  total_ += ns;
}

TimeNs DurationHistogram::quantile(double q) const {
  if (count_ == 0) return 0;
  const auto rank = std::clamp<std::uint64_t>(
      static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(count_))), 1, count_);
  std::uint64_t seen = 0;
  for (std::size_t bucket = 0; bucket < counts_.size(); ++bucket) {
    seen += counts_[bucket];
    if (seen >= rank) return std::min(end_of(bucket), max_);
  }
  return max_;
}

}  // namespace karst::core
