#include "plugins/simulator/cameras/rgb_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "plugins/simulator/cameras/rock_texture.h"
#include "plugins/simulator/sensors/range_noise.h"

namespace karst::sim {

using core::Vec3;
using core::Vec3f;

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kSight_m = 60;           // beyond it nothing is bright enough to be visible
const Vec3f kLamp_m(0.0f, 0.08f, 0.1f);  // offset from the lens, camera frame: left of it and above
constexpr double kLitFrom_m = 0.3, kStretch_m = 0.25;  // nearer droplets are dark; integration step
constexpr float kTooFaint_cdpm2 = 1e-4f;

/// Linear fraction of white to an sRGB byte (IEC 61966-2-1).
std::uint8_t srgb(float linear) {
  constexpr int kSteps = 4096;
  static const auto table = [] {
    std::array<std::uint8_t, kSteps + 1> t{};
    for (int i = 0; i <= kSteps; ++i) {
      const double v = static_cast<double>(i) / kSteps;
      const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
      t[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255 * s));
    }
    return t;
  }();
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative
  return table[static_cast<std::size_t>(std::clamp(linear, 0.0f, 1.0f) * kSteps + 0.5f)];
}

/// The luminance that is stored as white. Automatic exposure puts the geometric mean of the visible pixels at
/// 18 % of white, as a light meter does.
float white_of(const RgbOptions& o, const std::vector<Vec3f>& light) {
  const auto fixed = static_cast<float>(o.white_cdpm2);
  if (o.exposure == Exposure::fixed) return fixed;
  double sum = 0;
  std::size_t count = 0;
  for (const Vec3f& l : light)
    if (const float y = l.mean(); y > 1e-3f * fixed) {
      sum += std::log(static_cast<double>(y));
      ++count;
    }
  if (count == 0) return fixed;
  const auto mean = static_cast<float>(std::exp(sum / static_cast<double>(count)));
  return std::clamp(mean / 0.18f, fixed / 16, fixed * 16);
}

}  // namespace

void describe(core::OptionTable& t, RgbOptions& o) {
  t.add("fitted", o.fitted,
        "it carries a colour camera and a lamp; what the camera has seen is kept account of");
  t.add("pictures", o.pictures, "the camera's pictures are rendered and kept in the run directory");
  t.add("width", o.width, 16, 4096, "pixels a row");
  t.add("height", o.height, 16, 4096, "rows");
  t.add("fov", o.fov_rad, "rad", 0.2, 2.6, "horizontal field of view; pixels are square");
  t.add("pitch", o.pitch_rad, "rad", -1.5707, 1.5707, "of the optical axis above the horizon");
  t.add("range", o.range_m, "m", 0.5, 30, "farther rock is too dim, or not sharp enough, to count as seen");
  t.add("max_incidence", o.max_incidence_rad, "rad", 0.1, 1.55, "nor does rock seen more at a slant count");
  t.add("rate", o.rate_hz, "Hz", 0.1, 20, "pictures a second, rounded to whole steps of 5 ms");
  t.add("light", o.light, "flood: lights all in front alike; spot: a beam");
  t.add("intensity", o.intensity_cd, "cd", 1, 1e6, "luminous intensity of the lamp");
  t.add("beam", o.beam_rad, "rad", 0.1, 3, "width of the spot's beam");
  t.add("exposure", o.exposure, "auto: by each picture's own brightness");
  t.add("white", o.white_cdpm2, "cd/m^2", 1e-3, 1e6, "fixed exposure: the luminance stored as white");
  t.add("roughness", o.roughness_rad, "rad", 0, 1.2,
        "of the rock, deviation of its facets' slope (Oren-Nayar); 0: a Lambert surface");
  t.add("noise", o.noise, "", 0, 0.5,
        "of the sensor, as a share of white: in the dark, and twice that in white");
}

std::shared_ptr<const core::RgbCameraModel> rgb_camera_model(const RgbOptions& o) {
  auto m = std::make_shared<core::RgbCameraModel>();
  core::CameraModel& c = m->camera;
  c.name = "rgb";
  c.width = static_cast<int>(o.width);
  c.height = static_cast<int>(o.height);
  c.horizontal_fov_rad = o.fov_rad;
  c.vertical_fov_rad =
      2 * std::atan(std::tan(o.fov_rad / 2) * static_cast<double>(c.height) / static_cast<double>(c.width));
  c.min_range_m = 0.3f;
  c.max_range_m = static_cast<float>(o.range_m);
  c.period = core::from_seconds(std::max(std::round(200 / o.rate_hz), 1.0) * 0.005);
  c.T_body_camera.position = {0.15, 0, 0};
  c.T_body_camera.orientation = core::Quat(Eigen::AngleAxisd(-o.pitch_rad, Vec3::UnitY()));
  m->max_incidence_rad = o.max_incidence_rad;
  return m;
}

float reflected_fraction(const Vec3f& normal, const Vec3f& to_lamp, const Vec3f& to_eye,
                         float roughness_rad) {
  const float cos_in = normal.dot(to_lamp), cos_out = normal.dot(to_eye);
  if (cos_in <= 0 || cos_out <= 0) return 0;
  if (roughness_rad == 0) return cos_in;
  const float s2 = roughness_rad * roughness_rad;
  const float a = 1 - 0.5f * s2 / (s2 + 0.33f), b = 0.45f * s2 / (s2 + 0.09f);
  // cos(phi) sin(alpha) tan(beta), alpha the larger of both angles, without computing any angle.
  const float between = to_lamp.dot(to_eye) - cos_in * cos_out;  // cos(phi) sin(in) sin(out)
  const float facing = std::max(between, 0.0f) / std::max(cos_in, cos_out);
  return cos_in * (a + b * facing);
}

float beam_fraction(const RgbOptions& o, float cos_off_axis) {
  if (o.light == LampLight::flood) return cos_off_axis > 0 ? 1 : 0;
  const auto half = static_cast<float>(0.5 * o.beam_rad);
  const float inner = std::cos(half), outer = std::cos(std::min(1.2f * half, kPi));
  const float t = std::clamp((cos_off_axis - outer) / (inner - outer), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

RgbCamera::RgbCamera(const RgbOptions& o) : options_(o), model_(rgb_camera_model(o)) {
  for (int row = 0; row < model_->camera.height; ++row)
    for (int column = 0; column < model_->camera.width; ++column)
      beams_.push_back(model_->camera.direction(row, column));
}

/// For each pixel, whether the lamp, which is beside the lens, lights the rock in its view.
std::vector<bool> RgbCamera::lit(const cave::Cave& cave, const Vec3f& lamp,
                                 const std::vector<cave::Ray>& rays,
                                 const std::vector<cave::Hit>& hits) const {
  std::vector<cave::Ray> from_lamp(rays.size());
  std::vector<float> distance_m(rays.size(), 0);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const float range_m = hits[i].any() ? hits[i].range_m : 1;
    const Vec3f offset = rays[i].origin + range_m * rays[i].direction - lamp;
    distance_m[i] = offset.norm();
    from_lamp[i] = {lamp, offset / std::max(distance_m[i], 1e-6f)};
  }
  std::vector<cave::Hit> first(rays.size());
  cave.scene.cast(from_lamp, kSight_m, first);
  constexpr float kSlack_m = 2e-3f;
  std::vector<bool> lit(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    lit[i] = hits[i].any() && first[i].range_m > distance_m[i] * 0.999f - kSlack_m;
  return lit;
}

std::vector<Vec3f> RgbCamera::light(const cave::Cave& cave, const core::Pose& T_world_body,
                                    const Air& air) const {
  const core::Pose T_world_camera = T_world_body * model_->camera.T_body_camera;
  const Eigen::Matrix3f R = T_world_camera.orientation.toRotationMatrix().cast<float>();
  const Vec3f eye = T_world_camera.position.cast<float>(), lamp = eye + R * kLamp_m, axis = R.col(0);
  std::vector<cave::Ray> rays(beams_.size());
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = {eye, R * beams_[i]};
  std::vector<cave::Hit> hits(rays.size());
  cave.scene.cast(rays, kSight_m, hits);
  const std::vector<bool> is_lit = lit(cave, lamp, rays, hits);

  const auto intensity_cd = static_cast<float>(options_.intensity_cd);
  const auto roughness = static_cast<float>(options_.roughness_rad);
  const auto reflectivity = static_cast<float>(cave.description.reflectivity);
  const bool patched = !cave.description.patches.empty();
  const float pixel_rad =
      2 * std::tan(static_cast<float>(options_.fov_rad) / 2) / static_cast<float>(options_.width);
  std::vector<Vec3f> light(rays.size(), Vec3f::Zero());
  CloudyPath path;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const cave::Hit& hit = hits[i];
    const Vec3f& d = rays[i].direction;
    const float range_m = hit.any() ? hit.range_m : kSight_m;
    const bool cloudy = !air.clouds.empty() && (path.trace(air.clouds, rays[i]), !path.clear());
    if (is_lit[i]) {
      const Vec3f place = eye + range_m * d, to_lamp = lamp - place;
      const float distance_m = to_lamp.norm();
      const float lux =
          intensity_cd * beam_fraction(options_, -to_lamp.dot(axis) / distance_m) / (distance_m * distance_m);
      if (lux > kTooFaint_cdpm2) {
        const float rho = patched
                              ? static_cast<float>(reflectivity_at(cave.description, place.cast<double>()))
                              : reflectivity;
        // At a slant a pixel covers more rock in one direction, and no more in the other.
        const float cos_seen = std::sqrt(std::max(-hit.normal.dot(d), 0.05f));
        const RockLook look = rock_look(place.cast<double>(), pixel_rad * range_m / cos_seen);
        const Vec3f along = look.slope - look.slope.dot(hit.normal) * hit.normal;
        const Vec3f normal = (hit.normal - along).normalized();
        const float fraction = reflected_fraction(normal, to_lamp / distance_m, -d, roughness);
        light[i] = rho * lux * fraction / kPi * look.tint;
        if (cloudy) light[i] *= static_cast<float>(path.two_way(static_cast<double>(range_m)));
      }
    }
    if (cloudy) {
      const float beam = intensity_cd * beam_fraction(options_, d.dot(axis)) / kPi;
      path.for_each_stretch(
          kLitFrom_m, static_cast<double>(range_m), kStretch_m, [&](const CloudyPath::Stretch& s) {
            light[i] += Vec3f::Constant(beam * static_cast<float>(s.mean_echo / (s.from_m * s.to_m)));
          });
    }
    const float cos_field = beams_[i].x();
    light[i] *= cos_field * cos_field * cos_field * cos_field;
  }
  return light;
}

std::vector<std::uint8_t> RgbCamera::picture(const cave::Cave& cave, const core::Pose& T_world_body,
                                             core::Random random, const Air& air) const {
  const std::vector<Vec3f> seen = light(cave, T_world_body, air);
  const float white = white_of(options_, seen);
  const auto noise = static_cast<float>(options_.noise);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * seen.size());
  for (const Vec3f& l : seen)
    for (int c = 0; c < 3; ++c) {
      const float fraction = l[c] / white;
      // Photon noise: its standard deviation grows with the square root of the light.
      const float deviation = noise * std::sqrt(1 + 3 * std::min(fraction, 1.0f));
      rgb.push_back(srgb(fraction + deviation * range_noise(random)));
    }
  return rgb;
}

}  // namespace karst::sim
