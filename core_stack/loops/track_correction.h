// The correction of a path after loops were closed: rigid at each anchor, blended between two of them.
#pragma once
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"

namespace karst::core {

class TrackCorrection {
 public:
  struct Anchor {
    TimeNs stamp;
    Pose before, after;  // T_world_anchor
  };
  TrackCorrection() = default;
  /// Stamps strictly increasing.
  explicit TrackCorrection(std::vector<Anchor> anchors) : anchors_(std::move(anchors)) {}

  /// The corrected pose: unchanged without anchors; before the first anchor and after the last one by theirs.
  Pose operator()(TimeNs stamp, const Pose& T_world_body) const;

 private:
  std::vector<Anchor> anchors_;
};

}  // namespace karst::core
