// A colour camera with the vehicle's own lamp: renders pictures of a cave without other light.
//
// Rays are cast through every pixel, and from the lamp to the points they hit. A lamp of I candela lights
// rock at the distance d, at the angle theta to its normal, with E = I cos(theta) / d^2 lux. Rock of
// reflectivity rho is a Lambert surface of luminance rho E / pi, or if it is rough one of Oren and Nayar
// (Generalization of Lambert's reflectance model, SIGGRAPH 1994). Dust and droplets attenuate and scatter
// light on both paths (clouds.h). The lens dims the picture's corners by cos^4 of the angle from its axis.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/vehicle/rgb_camera_model.h"
#include "plugins/simulator/environment/clouds.h"

namespace karst::sim {

enum class LampLight { flood, spot };
constexpr auto names_of(LampLight) {
  using enum LampLight;
  return std::to_array<core::Named<LampLight>>({{flood, "flood"}, {spot, "spot"}});
}

/// automatic: set by each picture's own brightness.
enum class Exposure { automatic, fixed };
constexpr auto names_of(Exposure) {
  using enum Exposure;
  return std::to_array<core::Named<Exposure>>({{automatic, "auto"}, {fixed, "fixed"}});
}

struct RgbOptions {
  bool fitted = false;
  bool pictures = false;
  std::int64_t width = 320, height = 240;
  double fov_rad = 1.3962634, pitch_rad = 0, range_m = 6, max_incidence_rad = 1.2217305, rate_hz = 2;
  LampLight light = LampLight::flood;
  double intensity_cd = 1000, beam_rad = 1.0471976;
  Exposure exposure = Exposure::automatic;
  double white_cdpm2 = 15;
  double roughness_rad = 0.35;
  double noise = 0.01;
};
void describe(core::OptionTable& t, RgbOptions& o);

/// Forward, `pitch` up, in front of the vehicle. Pixels are square.
std::shared_ptr<const core::RgbCameraModel> rgb_camera_model(const RgbOptions& o);

/// Luminance of rock over reflectivity * illuminance / pi, cosine of the lamp's incidence included: 1 where a
/// smooth surface is lit head-on. `normal`, `to_lamp` and `to_eye` are unit vectors.
float reflected_fraction(const core::Vec3f& normal, const core::Vec3f& to_lamp, const core::Vec3f& to_eye,
                         float roughness_rad);

/// Fraction of the lamp's intensity at an angle off its axis: 1 within half the beam's width, falling to 0 at
/// 1.2 times that. A flood light covers the whole front hemisphere.
float beam_fraction(const RgbOptions& o, float cos_off_axis);

class RgbCamera {
 public:
  explicit RgbCamera(const RgbOptions& o);
  const std::shared_ptr<const core::RgbCameraModel>& model() const { return model_; }
  bool takes_pictures() const { return options_.pictures; }

  /// The picture as the sensor stores it: row-major, three bytes per pixel. May be called on any thread.
  std::vector<std::uint8_t> picture(const cave::Cave& cave, const core::Pose& T_world_body,
                                    core::Random random, const Air& air = {}) const;
  /// The light at the sensor: luminance in cd/m^2 for red, green and blue, vignetting included.
  std::vector<core::Vec3f> light(const cave::Cave& cave, const core::Pose& T_world_body,
                                 const Air& air = {}) const;

 private:
  std::vector<bool> lit(const cave::Cave& cave, const core::Vec3f& lamp, const std::vector<cave::Ray>& rays,
                        const std::vector<cave::Hit>& hits) const;

  RgbOptions options_;
  std::shared_ptr<const core::RgbCameraModel> model_;
  std::vector<core::Vec3f> beams_;  // unit vectors in the camera frame, row-major
};

}  // namespace karst::sim
