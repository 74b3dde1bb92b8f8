#include "sdk/preflight/vehicle/gyro_track.h"

#include <algorithm>

#include "core_stack/common/so3.h"

namespace karst::preflight {

std::vector<Orientation> gyro_track(std::span<const core::ImuSample> samples, const core::Vec3& bias_radps,
                                    const Eigen::Matrix3d& map) {
  std::vector<Orientation> track;
  core::Vec3 last_rate = core::Vec3::Zero();
  for (const core::ImuSample& s : samples) {
    if (!s.body_rate_radps.allFinite() || (!track.empty() && s.stamp <= track.back().stamp)) continue;
    const core::Vec3 rate = map * (s.body_rate_radps - bias_radps);
    if (track.empty()) {
      track.push_back({s.stamp, core::Quat::Identity()});
    } else {
      const double dt_s = core::seconds(s.stamp - track.back().stamp);
      track.push_back(
          {s.stamp, (track.back().q * core::exp_so3(0.5 * dt_s * (last_rate + rate))).normalized()});
    }
    last_rate = rate;
  }
  return track;
}

core::Quat orientation_at(std::span<const Orientation> track, core::TimeNs t) {
  const auto after = std::lower_bound(track.begin(), track.end(), t,
                                      [](const Orientation& o, core::TimeNs time) { return o.stamp < time; });
  if (after == track.begin()) return track.front().q;
  if (after == track.end()) return track.back().q;
  const Orientation &a = *(after - 1), &b = *after;
  return a.q.slerp(static_cast<double>(t - a.stamp) / static_cast<double>(b.stamp - a.stamp), b.q);
}

}  // namespace karst::preflight
