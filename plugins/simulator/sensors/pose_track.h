// The vehicle's recent poses, since a sweep is measured from a moving sensor.
#pragma once
#include <algorithm>
#include <vector>

#include "core_stack/common/pose_track.h"
#include "core_stack/common/time.h"

namespace karst::sim {

struct StampedPose {
  core::TimeNs stamp = 0;
  core::Pose pose;
};

/// Poses in the order of time.
using PoseTrack = std::vector<StampedPose>;

/// See core::pose_on_track; `track` is not empty.
inline core::Pose pose_at(const PoseTrack& track, core::TimeNs t) {
  return core::pose_on_track(track, t, &StampedPose::stamp, &StampedPose::pose);
}

/// Appends a pose, and drops all poses before `oldest` except the last of them.
inline void append(PoseTrack& track, const StampedPose& p, core::TimeNs oldest) {
  track.push_back(p);
  const auto keep =
      std::find_if(track.begin(), track.end(), [&](const StampedPose& q) { return q.stamp > oldest; });
  if (keep - track.begin() > 1) track.erase(track.begin(), keep - 1);
}

}  // namespace karst::sim
