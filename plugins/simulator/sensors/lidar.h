// A LiDAR: a spinning one with channels, or one with a pattern that does not repeat.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/vehicle/messages.h"
#include "plugins/simulator/environment/clouds.h"
#include "plugins/simulator/sensors/pose_track.h"

namespace karst::sim {

struct LidarOptions {
  std::string unit = "os0_32";
  std::int64_t columns = 512;
  double rate_hz = 10;
  double noise_m = 0.02;     // standard deviation of a range
  double dust_fraction = 0;  // fraction of beams returned by dust or droplets near the vehicle
  double mast_m = 0.1;       // height above the vehicle's centre
};
void describe(core::OptionTable& t, LidarOptions& o);

/// vlp16, os0_32, os0_64, os1_64, os0_128, xt32 and mid360: channels, vertical field of view and range of
/// well-known units. The mid360 has no columns, and sends 200,000 points a second whatever the options say.
std::shared_ptr<const core::LidarModel> lidar_model(const LidarOptions& o);

class Lidar {
 public:
  explicit Lidar(const LidarOptions& o);
  const std::shared_ptr<const core::LidarModel>& model() const { return model_; }

  /// The sweep that ends at `stamp`, each column cast from the sensor's pose when it fired. Const, so sweeps
  /// may be computed on any thread. An echo attenuated by clouds may be too weak to be detected, or a cloud's
  /// own echo may be reported in its place; without either there is no measurement (NaN).
  core::LidarScan sweep(const cave::Cave& cave, const PoseTrack& T_world_body, core::TimeNs stamp,
                        core::Random random, Air air = {}) const;

 private:
  struct Return {
    float range_m, intensity;
  };
  /// The return of a beam through clouds, given its return in clear air: the strongest echo is reported.
  Return through(const CloudyPath& path, const Return& clear, core::Random& random) const;
  /// What the unit says of a beam that meets `hit`: NaN without a valid measurement.
  Return measured(const cave::Cave& cave, const cave::Ray& ray, const cave::Hit& hit, core::Random& random,
                  Air& air, CloudyPath& path) const;
  /// Whether light that rock reflects at this range is too weak to be detected in clear air.
  bool is_too_dark(double reflected, double range_m) const;
  core::LidarScan sweep_of_points(const cave::Cave& cave, const PoseTrack& T_world_body, core::TimeNs stamp,
                                  core::Random random, Air air) const;

  LidarOptions options_;
  std::shared_ptr<const core::LidarModel> model_;
  std::vector<core::Vec3f> beams_;  // unit vectors in the lidar frame, channel-major; none without rings
  double dark_range_m_;             // see is_too_dark; 0: nothing is
};

/// Returned fraction of light: reflectivity * cos(incidence) / (1 + (range / 25 m)^2).
float return_intensity(double reflectivity, float cos_incidence, float range_m);

/// Light that the receiver gathers, up to a constant factor: reflectivity / range^2. Below 2 m its field of
/// view and the beam overlap in part only, and it gathers no more than at 2 m (the crossover function of
/// Hahner et al.; units differ, and vendors do not publish theirs).
double received_light(double reflectivity, double range_m);

}  // namespace karst::sim
