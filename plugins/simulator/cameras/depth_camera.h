// Depth cameras: pinhole, stereo-like noise, and the effect of droplets on stereo and on time of flight.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/vehicle/messages.h"
#include "plugins/simulator/environment/clouds.h"

namespace karst::sim {

/// tof: time of flight.
enum class DepthCameraKind { stereo, tof };
constexpr auto names_of(DepthCameraKind) {
  using enum DepthCameraKind;
  return std::to_array<core::Named<DepthCameraKind>>({{stereo, "stereo"}, {tof, "tof"}});
}

struct CameraOptions {
  double rate_hz = 5;
  double noise_at_1m_m = 0.003;  // grows with the square of the range, as a stereo camera's does
  DepthCameraKind kind = DepthCameraKind::stereo;
};
void describe(core::OptionTable& t, CameraOptions& o);

enum class Facing { forward, up, down };

/// The cameras of the vehicle presets. Up and down: 86 x 58 degrees, 80 x 56 pixels, 5 m. Forward:
/// 79 x 64 degrees, 80 x 64 pixels, 4.5 m, where a pixel covers 8 cm.
std::shared_ptr<const core::CameraModel> camera_model(const CameraOptions& o, Facing facing);

/// Light that a pixel receives from one range.
struct PixelLight {
  double range_m = 0, strength = 0;  // reflectivity / range^2
};

/// Stereo matches the rock's texture, whose contrast a veil of lit droplets reduces: the range noise grows as
/// the contrast falls, and below the minimum contrast there is no match and no measurement.
float stereo_range(const PixelLight& rock, std::span<const PixelLight> veil, float range_m,
                   float pixel_noise_m);

/// A continuous wave, modulated at 20 MHz, is measured by its phase, in which all light on one pixel adds up
/// as phasors: droplets near the lens pull the range towards it (Muraji et al., Depth from phasor distortions
/// in fog, Optics Express 27, 2019). Infinity where the sum is below the weakest detectable return; NaN where
/// its parts disagree, which the unit flags. Ranges wrap around at 7.5 m.
float tof_range(const PixelLight& rock, std::span<const PixelLight> veil, float range_m, double min_strength);

class DepthCamera {
 public:
  DepthCamera(const CameraOptions& o, std::shared_ptr<const core::CameraModel> model);
  const std::shared_ptr<const core::CameraModel>& model() const { return model_; }

  /// One image; const, so it may be called on any thread.
  core::DepthImage image(const cave::Cave& cave, const core::Pose& T_world_body, core::TimeNs stamp,
                         core::Random random, Air air = {}) const;

 private:
  /// A pixel's range with droplets on its ray. `rock` is the light that the pixel would receive from the rock
  /// in clear air.
  float through(const CloudyPath& path, const PixelLight& rock, float range_m, core::Random& random) const;

  CameraOptions options_;
  std::shared_ptr<const core::CameraModel> model_;
  std::vector<core::Vec3f> beams_;  // unit vectors in the camera frame, row-major
};

}  // namespace karst::sim
