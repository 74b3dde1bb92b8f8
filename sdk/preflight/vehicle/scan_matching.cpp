#include "sdk/preflight/vehicle/scan_matching.h"

namespace karst::preflight {

std::vector<Orientation> match_scans(std::span<const std::shared_ptr<const core::LidarScan>> scans,
                                     double self_radius_m, const core::LoamOptions& options) {
  core::Loam loam(options, core::Pose{});
  const core::StateHistory no_prediction;
  std::vector<Orientation> track;
  for (const auto& scan : scans) {
    if (!track.empty() && scan->stamp <= track.back().stamp) continue;
    const core::LoamPose pose = loam.process(core::to_sweep(*scan, self_radius_m), no_prediction);
    if (pose.valid) track.push_back({pose.stamp, pose.T_world_body.orientation});
  }
  return track;
}

}  // namespace karst::preflight
