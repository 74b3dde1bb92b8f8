// Where the vehicle was over the last moments: a sweep is measured from a moving sensor.
#pragma once
#include <algorithm>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"

namespace karst::sim {

struct StampedPose {
  core::TimeNs stamp = 0;
  core::Pose pose;
};

/// Poses in the order of time.
using PoseTrack = std::vector<StampedPose>;

/// Linear in position, spherical in rotation; held at either end.
inline core::Pose pose_at(const PoseTrack& track, core::TimeNs t) {
  const auto later = std::lower_bound(track.begin(), track.end(), t,
                                      [](const StampedPose& p, core::TimeNs time) { return p.stamp < time; });
  if (later == track.begin()) return track.front().pose;
  if (later == track.end()) return track.back().pose;
  const StampedPose &a = *(later - 1), &b = *later;
  const double share = static_cast<double>(t - a.stamp) / static_cast<double>(b.stamp - a.stamp);
  return {a.pose.position + share * (b.pose.position - a.pose.position),
          a.pose.orientation.slerp(share, b.pose.orientation)};
}

/// Appends, and forgets all but the one last pose from before `oldest`.
inline void append(PoseTrack& track, const StampedPose& p, core::TimeNs oldest) {
  track.push_back(p);
  const auto keep =
      std::find_if(track.begin(), track.end(), [&](const StampedPose& q) { return q.stamp > oldest; });
  if (keep - track.begin() > 1) track.erase(track.begin(), keep - 1);
}

}  // namespace karst::sim
