// Depth cameras: pinhole, stereo-like noise, and what droplets do to stereo and to time of flight.
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

/// Light that a pixel gathers from one place.
struct PixelLight {
  double range_m = 0, strength = 0;  // reflectivity / range^2
};

/// Two lenses match the rock's texture, which a veil of lit droplets makes faint: the range's noise grows as
/// the contrast falls, and below the least contrast there is no match, and no measurement.
float stereo_range(const PixelLight& rock, std::span<const PixelLight> veil, float range_m,
                   float pixel_noise_m);

/// A continuous wave, modulated at 20 MHz, is measured by its phase, in which all light on one pixel adds up
/// as phasors: droplets near the lens pull the range towards it (Muraji et al., Depth from phasor distortions
/// in fog, Optics Express 27, 2019). Where the sum is less than the weakest return, nothing is seen:
/// infinity; where its parts disagree, the unit flags it: NaN. Ranges wrap around at 7.5 m.
float tof_range(const PixelLight& rock, std::span<const PixelLight> veil, float range_m, double min_strength);

class DepthCamera {
 public:
  DepthCamera(const CameraOptions& o, std::shared_ptr<const core::CameraModel> model);
  const std::shared_ptr<const core::CameraModel>& model() const { return model_; }

  /// One image; const, and so for any thread.
  core::DepthImage image(const cave::Cave& cave, const core::Pose& T_world_body, core::TimeNs stamp,
                         core::Random random, Air air = {}) const;

 private:
  /// What becomes of a pixel's range where droplets are in the way. `rock` is the light that comes back from
  /// what it looks at in clear air.
  float through(const CloudyPath& path, const PixelLight& rock, float range_m, core::Random& random) const;

  CameraOptions options_;
  std::shared_ptr<const core::CameraModel> model_;
  std::vector<core::Vec3f> beams_;  // unit vectors in the camera frame, row-major
};

}  // namespace karst::sim
