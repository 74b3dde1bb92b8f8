#include "plugins/simulator/sensors/lidar.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "plugins/simulator/sensors/mid360_pattern.h"
#include "plugins/simulator/sensors/range_noise.h"

namespace karst::sim {

using core::TimeNs;
using core::Vec3;
using core::Vec3f;

namespace {

struct Unit {
  const char* name;
  int channels;  // 0: no rings
  double half_fov_deg;
  float max_range_m;
  double middle_deg = 0;   // elevation of the field of view's middle
  float dark_range_m = 0;  // at which rock of 10 % is just seen; 0: all rock is seen up to the greatest range
  float min_range_m = 0.3f;
};
// From the data sheets of Velodyne's VLP-16, Ouster's OS0 and OS1, Hesai's XT32 and Livox's Mid-360; ranges
// of spinning units for dark rock.
constexpr Unit kUnits[] = {{"vlp16", 16, 15, 100},
                           {"os0_32", 32, 45, 50},
                           {"os0_64", 64, 45, 50},
                           {"os1_64", 64, 22.5, 120},
                           {"os0_128", 128, 45, 50},
                           {"xt32", 32, 15.5, 80, -0.5, 0, 0.05f},
                           {"mid360", 0, 29.5, 70, 22.5, 40, 0.1f}};

const Unit& unit_of(const LidarOptions& o) {
  return *std::find_if(std::begin(kUnits), std::end(kUnits) - 1,
                       [&](const Unit& u) { return o.unit == u.name; });
}

float radians(double deg) { return static_cast<float>(deg * std::numbers::pi / 180); }

constexpr float kRangeStep_m = 0.001f;  // as the units report ranges
constexpr double kPulse_m = 0.75;       // c t / 2 of a pulse of 5 ns: nearer targets merge into one echo

}  // namespace

void describe(core::OptionTable& t, LidarOptions& o) {
  std::vector<std::string> units;
  for (const Unit& u : kUnits) units.emplace_back(u.name);
  t.add("unit", o.unit, std::move(units),
        "16 channels in 30 deg; 32 in 90; 64 in 90; 64 in 45; 128 in 90; 32 in 31; no channels, 59 deg");
  t.add("columns", o.columns, 64, 4096, "beams a channel and revolution");
  t.add("rate", o.rate_hz, "Hz", 1, 20, "revolutions a second, rounded to whole steps of 5 ms");
  t.add("noise", o.noise_m, "m", 0, 1, "standard deviation of a range");
  t.add(
      "dust", o.dust_fraction, "", 0, 0.9,
      "share of beams sent back from anywhere near, whatever is there: for tests; physical dust is in air.*");
  t.add("mast", o.mast_m, "m", -1, 1, "height of the sensor above the vehicle's centre");
}

std::shared_ptr<const core::LidarModel> lidar_model(const LidarOptions& o) {
  const Unit& unit = unit_of(o);
  auto model = std::make_shared<core::LidarModel>();
  model->name = unit.name;
  model->period = core::from_seconds(std::round(200 / o.rate_hz) * 0.005);
  model->columns = unit.channels == 0 ? 0 : static_cast<int>(o.columns);
  for (int i = 0; i < unit.channels; ++i)
    model->elevation_rad.push_back(
        radians(unit.middle_deg + unit.half_fov_deg * (1 - 2.0 * i / (unit.channels - 1))));
  if (!model->has_rings())
    model->elevation_rad = {radians(unit.middle_deg + unit.half_fov_deg),
                            radians(unit.middle_deg - unit.half_fov_deg)};
  model->min_range_m = unit.min_range_m;
  model->max_range_m = unit.max_range_m;
  model->T_body_lidar.position = {0, 0, o.mast_m};
  return model;
}

float return_intensity(double reflectivity, float cos_incidence, float range_m) {
  const float fall_off = 1 + (range_m / 25) * (range_m / 25);
  return std::clamp(static_cast<float>(reflectivity) * cos_incidence / fall_off, 0.0f, 1.0f);
}

double received_light(double reflectivity, double range_m) {
  constexpr double kFullOverlap_m = 2;
  const double r = std::max(range_m, kFullOverlap_m);
  return reflectivity / (r * r);
}

Lidar::Lidar(const LidarOptions& o)
    : options_(o), model_(lidar_model(o)), dark_range_m_(static_cast<double>(unit_of(o).dark_range_m)) {
  if (!model_->has_rings()) return;
  for (int c = 0; c < model_->channels(); ++c)
    for (int j = 0; j < model_->columns; ++j) beams_.push_back(model_->direction(c, j));
}

Lidar::Return Lidar::through(const CloudyPath& path, const Return& clear, core::Random& random) const {
  const double max_range_m = static_cast<double>(model_->max_range_m);
  const double end_m = std::min(static_cast<double>(clear.range_m), max_range_m);
  if (path.depth(end_m) == 0) return clear;
  const double left = path.two_way(end_m);
  const double reflectivity = static_cast<double>(clear.intensity / return_intensity(1, 1, clear.range_m));
  // The weakest detectable echo: that of rock of 10 % at the maximum range, as data sheets state it.
  double strongest = received_light(0.1, dark_range_m_ > 0 ? dark_range_m_ : max_range_m);
  Return best{std::numeric_limits<float>::quiet_NaN(), 0};
  if (const double light = received_light(reflectivity * left, end_m); light >= strongest) {
    strongest = light;
    best = {clear.range_m, clear.intensity * static_cast<float>(left)};
  }
  path.for_each_stretch(static_cast<double>(model_->min_range_m), end_m, kPulse_m,
                        [&](const CloudyPath::Stretch& s) {
                          const double echo = s.echo(random), range_m = s.place_m(random);
                          const double light = received_light(echo, range_m);
                          if (light < strongest) return;
                          strongest = light;
                          const auto range = static_cast<float>(range_m);
                          best = {range, return_intensity(echo, 1, range)};
                        });
  return best;
}

Lidar::Return Lidar::measured(const cave::Cave& cave, const cave::Ray& ray, const cave::Hit& hit,
                              core::Random& random, Air& air, CloudyPath& path) const {
  float range = hit.range_m, intensity = 0;
  if (hit.any()) {
    const Vec3f place = ray.origin + range * ray.direction;
    const double reflectivity = cave.description.patches.empty()
                                    ? cave.description.reflectivity
                                    : cave::reflectivity_at(cave.description, place.cast<double>());
    const float cos_incidence = -hit.normal.dot(ray.direction);
    intensity = return_intensity(reflectivity, cos_incidence, range);
    if (is_too_dark(reflectivity * static_cast<double>(cos_incidence), static_cast<double>(range)))
      range = std::numeric_limits<float>::infinity(), intensity = 0;
    range = std::max(range + static_cast<float>(options_.noise_m) * range_noise(random), 0.0f);
  }
  if (options_.dust_fraction > 0 && random.uniform() < options_.dust_fraction) {
    const auto dust = static_cast<float>(random.uniform(0.4, 3.0));
    if (dust < range) {
      range = dust;
      intensity = static_cast<float>(random.uniform(0, 0.02));
    }
  }
  if (!air.clouds.empty()) {
    path.trace(air.clouds, ray);
    if (!path.clear()) {
      const Return r = through(path, {range, intensity}, air.random);
      range = r.range_m;
      intensity = r.intensity;
    }
  }
  range = kRangeStep_m * std::round(range / kRangeStep_m);
  if (range < model_->min_range_m) return {std::numeric_limits<float>::quiet_NaN(), 0};
  return {range, intensity};
}

bool Lidar::is_too_dark(double reflected, double range_m) const {
  return dark_range_m_ > 0 && received_light(reflected, range_m) < received_light(0.1, dark_range_m_);
}

core::LidarScan Lidar::sweep(const cave::Cave& cave, const PoseTrack& T_world_body, TimeNs stamp,
                             core::Random random, Air air) const {
  if (!model_->has_rings()) return sweep_of_points(cave, T_world_body, stamp, random, std::move(air));
  const auto columns = static_cast<std::size_t>(model_->columns);
  std::vector<Eigen::Matrix3f> rotations(columns);
  std::vector<Vec3f> origins(columns);
  for (std::size_t j = 0; j < columns; ++j) {
    const TimeNs fired =
        stamp - model_->period + model_->period * static_cast<TimeNs>(j + 1) / model_->columns;
    const core::Pose T_world_lidar = pose_at(T_world_body, fired) * model_->T_body_lidar;
    rotations[j] = T_world_lidar.orientation.toRotationMatrix().cast<float>();
    origins[j] = T_world_lidar.position.cast<float>();
  }

  core::LidarScan scan{stamp, model_, std::vector<float>(beams_.size()), std::vector<float>(beams_.size())};
  std::vector<cave::Ray> rays(columns);
  std::vector<cave::Hit> hits(columns);
  CloudyPath path;
  for (std::size_t first = 0; first < beams_.size(); first += columns) {  // a channel at a time: neighbours
    for (std::size_t j = 0; j < columns; ++j) rays[j] = {origins[j], rotations[j] * beams_[first + j]};
    cave.scene.cast(rays, model_->max_range_m, hits);
    for (std::size_t j = 0; j < columns; ++j) {
      const Return r = measured(cave, rays[j], hits[j], random, air, path);
      scan.range_m[first + j] = r.range_m;
      scan.intensity[first + j] = r.intensity;
    }
  }
  return scan;
}

/// A Mid-360 says nothing of beams without a return: they are left out.
core::LidarScan Lidar::sweep_of_points(const cave::Cave& cave, const PoseTrack& T_world_body, TimeNs stamp,
                                       core::Random random, Air air) const {
  core::LidarScan scan{stamp, model_, {}, {}};
  const std::int64_t shots = model_->period / kMid360Step, end = stamp / kMid360Step;
  constexpr std::size_t kBatch = 16;  // shots from one pose: 80 us, 0.4 mm at 5 m/s
  std::vector<Vec3f> directions;
  std::vector<cave::Ray> rays;
  std::vector<cave::Hit> hits(kBatch);
  CloudyPath path;
  for (std::int64_t shot = end - shots; shot < end; shot += static_cast<std::int64_t>(kBatch)) {
    const std::size_t batch = std::min(kBatch, static_cast<std::size_t>(end - shot));
    const TimeNs middle = (shot + static_cast<std::int64_t>(batch) / 2) * kMid360Step;
    const core::Pose T_world_lidar = pose_at(T_world_body, middle) * model_->T_body_lidar;
    const Eigen::Matrix3f rotation = T_world_lidar.orientation.toRotationMatrix().cast<float>();
    directions.clear();
    rays.clear();
    for (std::size_t i = 0; i < batch; ++i) {
      directions.push_back(mid360_direction(shot + static_cast<std::int64_t>(i)));
      rays.push_back({T_world_lidar.position.cast<float>(), rotation * directions.back()});
    }
    cave.scene.cast(rays, model_->max_range_m, std::span(hits).first(batch));
    for (std::size_t i = 0; i < batch; ++i) {
      const Return r = measured(cave, rays[i], hits[i], random, air, path);
      if (!std::isfinite(r.range_m)) continue;
      scan.range_m.push_back(r.range_m);
      scan.intensity.push_back(r.intensity);
      scan.direction.push_back(directions[i]);
      const TimeNs fired = (shot + static_cast<std::int64_t>(i)) * kMid360Step;
      scan.time_s.push_back(static_cast<float>(core::seconds(std::min<TimeNs>(fired - stamp, 0))));
    }
  }
  return scan;
}

}  // namespace karst::sim
