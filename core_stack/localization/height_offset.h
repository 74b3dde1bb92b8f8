// Offset of the barometer: learnt while the height is known, so that it can provide the height later.
#pragma once
#include "core_stack/vehicle/messages.h"

namespace karst::core {

class HeightOffset {
 public:
  /// Adds a sample made at a known height in the world frame.
  void learn(const BarometerSample& sample, double height_m);
  bool known() const { return learnt_ >= kKnown; }
  /// Height in the world frame from a sample.
  double height_m(const BarometerSample& sample) const { return sample.height_m - offset_m_; }

 private:
  /// Samples until the offset is known; length of the average: 10 s at 25 Hz follow the drift.
  static constexpr int kKnown = 10, kAverage = 250;
  double offset_m_ = 0;
  int learnt_ = 0;
};

inline void HeightOffset::learn(const BarometerSample& sample, double height_m) {
  learnt_ = learnt_ < kAverage ? learnt_ + 1 : kAverage;
  offset_m_ += (sample.height_m - height_m - offset_m_) / learnt_;
}

}  // namespace karst::core
