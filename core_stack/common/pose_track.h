// Poses between those of a track.
#pragma once
#include <algorithm>
#include <functional>

#include "core_stack/common/geometry.h"

namespace karst::core {

/// Pose at time `t` on a track in the order of time, not empty: linear in position, spherical in rotation,
/// the nearest end outside its range. `stamp_of` and `pose_of` are members of the track's elements.
template <class Track, class Time, class StampOf, class PoseOf>
Pose pose_on_track(const Track& track, Time t, StampOf stamp_of, PoseOf pose_of) {
  const auto stamp = [&](const auto& element) -> Time { return std::invoke(stamp_of, element); };
  const auto after = std::lower_bound(track.begin(), track.end(), t,
                                      [&](const auto& element, Time time) { return stamp(element) < time; });
  if (after == track.begin()) return std::invoke(pose_of, track.front());
  if (after == track.end()) return std::invoke(pose_of, track.back());
  const auto before = after - 1;
  const double fraction =
      static_cast<double>(t - stamp(*before)) / static_cast<double>(stamp(*after) - stamp(*before));
  const Pose a = std::invoke(pose_of, *before), b = std::invoke(pose_of, *after);
  return {a.position + fraction * (b.position - a.position),
          a.orientation.slerp(fraction, b.orientation).normalized()};
}

}  // namespace karst::core
