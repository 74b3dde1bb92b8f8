#include "core_stack/loops/track_correction.h"

#include <algorithm>

namespace karst::core {

Pose TrackCorrection::operator()(TimeNs stamp, const Pose& T_world_body) const {
  if (anchors_.empty()) return T_world_body;
  const auto by = [&](const Anchor& a) { return a.after * (a.before.inverse() * T_world_body); };
  const auto next = std::upper_bound(anchors_.begin(), anchors_.end(), stamp,
                                     [](TimeNs t, const Anchor& a) { return t < a.stamp; });
  if (next == anchors_.begin()) return by(*next);
  const Anchor& last = *(next - 1);
  if (next == anchors_.end()) return by(last);
  const double part = seconds(stamp - last.stamp) / seconds(next->stamp - last.stamp);
  const Pose a = by(last), b = by(*next);
  return {a.position + part * (b.position - a.position),
          a.orientation.slerp(part, b.orientation).normalized()};
}

}  // namespace karst::core
