#include "plugins/simulator/sensors/lidar.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plugins/simulator/sensors/range_noise.h"

namespace karst::sim {

using core::TimeNs;
using core::Vec3;
using core::Vec3f;

namespace {

struct Unit {
  const char* name;
  int channels;
  double half_fov_deg;
  float max_range_m;
};
// From the data sheets of Velodyne's VLP-16 and Ouster's OS0 and OS1; ranges for dark rock.
constexpr Unit kUnits[] = {{"vlp16", 16, 15, 100},
                           {"os0_32", 32, 45, 50},
                           {"os0_64", 64, 45, 50},
                           {"os1_64", 64, 22.5, 120},
                           {"os0_128", 128, 45, 50}};

constexpr float kRangeStep_m = 0.001f;  // as the units report ranges
constexpr double kPulse_m = 0.75;       // c t / 2 of a pulse of 5 ns: nearer targets merge into one echo

}  // namespace

void describe(core::OptionTable& t, LidarOptions& o) {
  std::vector<std::string> units;
  for (const Unit& u : kUnits) units.emplace_back(u.name);
  t.add("unit", o.unit, std::move(units), "16 channels in 30 deg; 32 in 90; 64 in 90; 64 in 45; 128 in 90");
  t.add("columns", o.columns, 64, 4096, "beams a channel and revolution");
  t.add("rate", o.rate_hz, "Hz", 1, 20, "revolutions a second, rounded to whole steps of 5 ms");
  t.add("noise", o.noise_m, "m", 0, 1, "standard deviation of a range");
  t.add(
      "dust", o.dust_fraction, "", 0, 0.9,
      "share of beams sent back from anywhere near, whatever is there: for tests; physical dust is in air.*");
  t.add("mast", o.mast_m, "m", -1, 1, "height of the sensor above the vehicle's centre");
}

std::shared_ptr<const core::LidarModel> lidar_model(const LidarOptions& o) {
  const Unit& unit = *std::find_if(std::begin(kUnits), std::end(kUnits) - 1,
                                   [&](const Unit& u) { return o.unit == u.name; });
  auto model = std::make_shared<core::LidarModel>();
  model->name = unit.name;
  model->period = core::from_seconds(std::round(200 / o.rate_hz) * 0.005);
  model->columns = static_cast<int>(o.columns);
  for (int i = 0; i < unit.channels; ++i) {
    const double elevation_deg = unit.half_fov_deg * (1 - 2.0 * i / (unit.channels - 1));
    model->elevation_rad.push_back(static_cast<float>(elevation_deg * std::numbers::pi / 180));
  }
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

Lidar::Lidar(const LidarOptions& o) : options_(o), model_(lidar_model(o)) {
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
  double strongest = received_light(0.1, max_range_m);
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

core::LidarScan Lidar::sweep(const cave::Cave& cave, const PoseTrack& T_world_body, TimeNs stamp,
                             core::Random random, Air air) const {
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
  const auto noise_m = static_cast<float>(options_.noise_m);
  const bool patched = !cave.description.patches.empty();
  std::vector<cave::Ray> rays(columns);
  std::vector<cave::Hit> hits(columns);
  CloudyPath path;
  for (std::size_t first = 0; first < beams_.size(); first += columns) {  // a channel at a time: neighbours
    for (std::size_t j = 0; j < columns; ++j) rays[j] = {origins[j], rotations[j] * beams_[first + j]};
    cave.scene.cast(rays, model_->max_range_m, hits);
    for (std::size_t j = 0; j < columns; ++j) {
      const cave::Hit& hit = hits[j];
      float range = hit.range_m, intensity = 0;
      if (hit.any()) {
        const Vec3f place = rays[j].origin + range * rays[j].direction;
        const double reflectivity = patched ? cave::reflectivity_at(cave.description, place.cast<double>())
                                            : cave.description.reflectivity;
        intensity = return_intensity(reflectivity, -hit.normal.dot(rays[j].direction), range);
        range = std::max(range + noise_m * range_noise(random), 0.0f);
      }
      if (options_.dust_fraction > 0 && random.uniform() < options_.dust_fraction) {
        const auto dust = static_cast<float>(random.uniform(0.4, 3.0));
        if (dust < range) {
          range = dust;
          intensity = static_cast<float>(random.uniform(0, 0.02));
        }
      }
      if (!air.clouds.empty()) {
        path.trace(air.clouds, rays[j]);
        if (!path.clear()) {
          const Return r = through(path, {range, intensity}, air.random);
          range = r.range_m;
          intensity = r.intensity;
        }
      }
      range = kRangeStep_m * std::round(range / kRangeStep_m);
      if (range < model_->min_range_m) {
        range = std::numeric_limits<float>::quiet_NaN();
        intensity = 0;
      }
      scan.range_m[first + j] = range;
      scan.intensity[first + j] = intensity;
    }
  }
  return scan;
}

}  // namespace karst::sim
