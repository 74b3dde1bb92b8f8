// PCL's GICP and NDT as one would use them for LiDAR odometry: voxel-filtered sweeps against a map of the
// last keyframes. Each takes the same compensated sweeps and the same kind of prediction as LOAM.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::bench {

class PclOdometry {
 public:
  /// `method`: "GICP" or "NDT".
  PclOdometry(const std::string& method, const core::Pose& T_world_start);
  ~PclOdometry();
  PclOdometry(PclOdometry&&) noexcept;

  /// The pose of a sweep whose points are given in the body frame, from a guess.
  core::Pose process(const std::vector<core::Vec3f>& points_body, const core::Pose& guess);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace karst::bench
