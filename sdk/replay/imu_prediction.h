// Predicts the states between scans from the recording's IMU, as the initial guess of LOAM.
#pragma once
#include <optional>

#include "core_stack/localization/estimator.h"
#include "core_stack/localization/loam.h"
#include "plugins/replay/sensor_stream.h"

namespace karst::replay {

class ImuPrediction {
 public:
  /// Reads the samples up to `still_s` after the start of the first scan or of the IMU data, whichever is
  /// later. Returned times are relative to `origin`.
  ImuPrediction(SensorStream& sensors, const core::EstimatorOptions& options, core::TimeNs origin, bool level,
                double still_s);

  /// The start pose; if it is to be levelled, its roll and pitch come from the mean specific force.
  core::Pose T_world_start() const { return T_world_start_; }
  /// Propagates to `stamp`; the states stay valid until the next call.
  const core::StateHistory& up_to(core::TimeNs stamp);
  void correct(const core::LoamPose& pose);
  std::size_t samples() const { return samples_; }

 private:
  std::optional<core::ImuSample> take();

  SensorStream& sensors_;
  core::TimeNs origin_;
  std::vector<core::ImuSample> waiting_;  // read ahead, newest first
  core::Pose T_world_start_;
  std::optional<core::Estimator> estimator_;
  std::size_t samples_ = 0;
};

}  // namespace karst::replay
