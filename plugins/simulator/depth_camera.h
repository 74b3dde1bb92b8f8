// Depth cameras: pinhole, stereo-like noise.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/vehicle/messages.h"
#include "plugins/simulator/cave/cave.h"

namespace karst::sim {

struct CameraOptions {
  double rate_hz = 5;
  double noise_at_1m_m = 0.003;  // grows with the square of the range, as a stereo camera's does
};
void describe(core::OptionTable& t, CameraOptions& o);

enum class Facing { forward, up, down };

/// The cameras of the vehicle presets. Up and down: 86 x 58 degrees, 80 x 56 pixels, 5 m. Forward:
/// 79 x 64 degrees, 80 x 64 pixels, 4.5 m, where a pixel covers 8 cm.
std::shared_ptr<const core::CameraModel> camera_model(const CameraOptions& o, Facing facing);

class DepthCamera {
 public:
  DepthCamera(const CameraOptions& o, std::shared_ptr<const core::CameraModel> model);
  const std::shared_ptr<const core::CameraModel>& model() const { return model_; }

  /// One image; const, and so for any thread.
  core::DepthImage image(const cave::Cave& cave, const core::Pose& T_world_body, core::TimeNs stamp,
                         core::Random random) const;

 private:
  CameraOptions options_;
  std::shared_ptr<const core::CameraModel> model_;
  std::vector<core::Vec3f> beams_;  // unit vectors in the camera frame, row-major
};

}  // namespace karst::sim
