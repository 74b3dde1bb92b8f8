// How far the barometer is off: learnt while the height is known, so that it holds the height when it is not.
#pragma once
#include "core_stack/vehicle/messages.h"

namespace karst::core {

class HeightOffset {
 public:
  /// Takes in a sample made at a height that is known.
  void learn(const BarometerSample& sample, double height_m);
  bool known() const { return learnt_ >= kKnown; }
  /// Height in the world by a sample.
  double height_m(const BarometerSample& sample) const { return sample.height_m - offset_m_; }

 private:
  /// Samples until it is known, and over how many it is averaged: ten seconds at 25 Hz follow the drift.
  static constexpr int kKnown = 10, kAverage = 250;
  double offset_m_ = 0;
  int learnt_ = 0;
};

inline void HeightOffset::learn(const BarometerSample& sample, double height_m) {
  learnt_ = learnt_ < kAverage ? learnt_ + 1 : kAverage;
  offset_m_ += (sample.height_m - height_m - offset_m_) / learnt_;
}

}  // namespace karst::core
