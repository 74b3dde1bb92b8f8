#include "plugins/simulator/cameras/depth_camera.h"

#include <algorithm>
#include <complex>
#include <numbers>

#include "plugins/simulator/sensors/range_noise.h"

namespace karst::sim {

using core::Quat;
using core::Vec3;

void describe(core::OptionTable& t, CameraOptions& o) {
  t.add("rate", o.rate_hz, "Hz", 1, 50, "images a second, rounded to whole steps of 5 ms");
  t.add("noise", o.noise_at_1m_m, "m", 0, 0.2,
        "standard deviation at 1 m; grows with the square of the range");
  t.add("kind", o.kind, "how it measures: droplets are much worse for time of flight");
}

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
constexpr double kCameraStretch_m = 0.25;  // integration step of the veil's light, << the 7.5 m wave

}  // namespace

float stereo_range(const PixelLight& rock, std::span<const PixelLight> veil, float range_m,
                   float pixel_noise_m) {
  constexpr double kMinContrast = 0.1;
  double all = rock.strength;
  for (const PixelLight& v : veil) all += v.strength;
  const double contrast = rock.strength / all;
  if (!(contrast >= kMinContrast)) return kNan;
  return range_m + pixel_noise_m * static_cast<float>(1 / contrast - 1);
}

float tof_range(const PixelLight& rock, std::span<const PixelLight> veil, float range_m,
                double min_strength) {
  constexpr double kWave_m = 7.5;        // c / (2 * 20 MHz)
  constexpr double kMinAgreement = 0.7;  // length of the sum over the sum of the lengths
  const auto phasor = [](const PixelLight& l) {
    return std::polar(l.strength, 2 * std::numbers::pi * l.range_m / kWave_m);
  };
  std::complex<double> sum = phasor(rock);
  double lengths = rock.strength;
  for (const PixelLight& v : veil) {
    sum += phasor(v);
    lengths += v.strength;
  }
  if (std::abs(sum) < min_strength) return kInf;
  if (std::abs(sum) < kMinAgreement * lengths) return kNan;
  const double turned = std::atan2(sum.imag(), sum.real()) / (2 * std::numbers::pi);
  const double mixed_m = kWave_m * (turned < 0 ? turned + 1 : turned);
  return std::isfinite(range_m) ? range_m + static_cast<float>(mixed_m - rock.range_m)
                                : static_cast<float>(mixed_m);
}

std::shared_ptr<const core::CameraModel> camera_model(const CameraOptions& o, Facing facing) {
  constexpr double kDegree = std::numbers::pi / 180;
  auto m = std::make_shared<core::CameraModel>();
  m->period = core::from_seconds(std::max(std::round(200 / o.rate_hz), 1.0) * 0.005);
  if (facing == Facing::forward) {
    m->name = "forward";
    m->width = 80;
    m->height = 64;
    m->horizontal_fov_rad = 79 * kDegree;
    m->vertical_fov_rad = 64 * kDegree;
    m->max_range_m = 4.5f;
    m->T_body_camera.position = {0.15, 0, 0};
    return m;
  }
  m->width = 80;
  m->height = 56;
  m->horizontal_fov_rad = 86 * kDegree;
  m->vertical_fov_rad = 58 * kDegree;
  m->max_range_m = 5.0f;
  const double up = facing == Facing::up ? 1 : -1;
  m->name = facing == Facing::up ? "up" : "down";
  m->T_body_camera.position = {0, 0, 0.1 * up};
  // The optical axis (camera x) along body z: a quarter turn about y.
  m->T_body_camera.orientation = Quat(Eigen::AngleAxisd(-up * std::numbers::pi / 2, Vec3::UnitY()));
  return m;
}

namespace {

/// The light a pixel receives in clear air. With no rock in range it is that of bare rock at the maximum
/// range.
PixelLight light_of(const cave::Cave& cave, const cave::Ray& ray, const cave::Hit& hit, float max_range_m) {
  if (!hit.any()) return {max_range_m, cave.description.reflectivity / (max_range_m * max_range_m)};
  const Vec3 place = (ray.origin + hit.range_m * ray.direction).cast<double>();
  const auto range_m = static_cast<double>(hit.range_m);
  return {range_m, cave::reflectivity_at(cave.description, place) *
                       static_cast<double>(-hit.normal.dot(ray.direction)) / (range_m * range_m)};
}

}  // namespace

DepthCamera::DepthCamera(const CameraOptions& o, std::shared_ptr<const core::CameraModel> model)
    : options_(o), model_(std::move(model)) {
  for (int row = 0; row < model_->height; ++row)
    for (int column = 0; column < model_->width; ++column) beams_.push_back(model_->direction(row, column));
}

float DepthCamera::through(const CloudyPath& path, const PixelLight& rock, float range_m,
                           core::Random& random) const {
  if (path.depth(rock.range_m) == 0) return range_m;
  const bool tof = options_.kind == DepthCameraKind::tof;
  // The lamp of a time-of-flight camera sits beside its lens, the lamps for stereo are farther away: only
  // beyond this range do they light the field of view. Nearer droplets are dark, and out of focus.
  const double lit_from_m = tof ? 0.3 : 0.5;
  const PixelLight left{rock.range_m, rock.strength * path.two_way(rock.range_m)};
  std::vector<PixelLight> veil;
  path.for_each_stretch(lit_from_m, rock.range_m, kCameraStretch_m, [&](const CloudyPath::Stretch& s) {
    // 1 / r^2 averaged over the interval.
    veil.push_back({(s.from_m + s.to_m) / 2, s.echo(random) / (s.from_m * s.to_m)});
  });
  const float noise_m = std::isfinite(range_m) ? range_m - static_cast<float>(rock.range_m) : 0;
  if (!tof) return stereo_range(left, veil, range_m, noise_m);
  const double max_range_m = static_cast<double>(model_->max_range_m);
  const PixelLight seen = std::isfinite(range_m) ? left : PixelLight{rock.range_m, 0};
  return tof_range(seen, veil, range_m, 0.1 / (max_range_m * max_range_m));
}

core::DepthImage DepthCamera::image(const cave::Cave& cave, const core::Pose& T_world_body,
                                    core::TimeNs stamp, core::Random random, Air air) const {
  const core::Pose T_world_camera = T_world_body * model_->T_body_camera;
  const Eigen::Matrix3f R = T_world_camera.orientation.toRotationMatrix().cast<float>();
  std::vector<cave::Ray> rays(beams_.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays[i] = {T_world_camera.position.cast<float>(), R * beams_[i]};
  std::vector<cave::Hit> hits(rays.size());
  cave.scene.cast(rays, model_->max_range_m, hits);

  core::DepthImage image{stamp, model_, std::vector<float>(rays.size())};
  const auto noise = static_cast<float>(options_.noise_at_1m_m);
  CloudyPath path;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    float range = hits[i].range_m;
    if (hits[i].any()) range += noise * range * range * range_noise(random);
    if (!air.clouds.empty()) {
      path.trace(air.clouds, rays[i]);
      if (!path.clear())
        range = through(path, light_of(cave, rays[i], hits[i], model_->max_range_m), range, air.random);
    }
    if (range < model_->min_range_m) range = std::numeric_limits<float>::quiet_NaN();
    image.range_m[i] = range;
  }
  return image;
}

}  // namespace karst::sim
