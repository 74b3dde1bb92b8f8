// The states between scans by the recording's IMU, for LOAM to start from.
#pragma once
#include <optional>

#include "core_stack/localization/estimator.h"
#include "core_stack/localization/loam.h"
#include "plugins/replay/imu_file.h"

namespace karst::replay {

class ImuPrediction {
 public:
  /// Reads the samples up to `still_s` after the first scan begins, or after the IMU does, whichever is
  /// later. Times handed on are counted from `origin`.
  ImuPrediction(ImuFile file, const core::EstimatorOptions& options, core::TimeNs origin, bool level,
                double still_s);

  /// Where the body's z axis points at the start, if it is to be level: from the mean specific force.
  core::Pose T_world_start() const { return T_world_start_; }
  /// Propagates to `stamp`; the states stay valid until the next call.
  const core::StateHistory& up_to(core::TimeNs stamp);
  void correct(const core::LoamPose& pose);
  std::size_t samples() const { return samples_; }

 private:
  std::optional<core::ImuSample> take();

  ImuFile file_;
  core::TimeNs origin_;
  std::vector<core::ImuSample> waiting_;  // read ahead, newest first
  core::Pose T_world_start_;
  std::optional<core::Estimator> estimator_;
  std::size_t samples_ = 0;
};

}  // namespace karst::replay
