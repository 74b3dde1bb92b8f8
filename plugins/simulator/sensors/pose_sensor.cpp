#include "plugins/simulator/sensors/pose_sensor.h"

#include <cmath>

#include "core_stack/common/random_vector.h"

namespace karst::sim {

using core::Quat;
using core::Vec3;

namespace {

constexpr double kDriftPath_m = 100;

}  // namespace

void describe(core::OptionTable& t, PoseSensorOptions& o) {
  t.add("fitted", o.fitted, "which vehicles carry it; one with a LiDAR locates itself");
  t.add("rate", o.rate_hz, "Hz", 1, 200, "samples a second, rounded to whole steps of 5 ms");
  t.add("delay", o.delay_s, "s", 0, 1, "from measurement to arrival");
  t.add("noise", o.noise_m, "m", 0, 1, "standard deviation of each component of the position");
  t.add("angle_noise", o.noise_rad, "rad", 0, 0.5, "standard deviation of each component of the rotation");
  t.add("drift", o.drift_percent, "%", 0, 10, "standard deviation of the drift after 100 m of path");
  t.add("heading_drift", o.heading_drift_rad, "rad", 0, 0.5,
        "standard deviation of the heading after 100 m of path");
}

PoseSensor::PoseSensor(const PoseSensorOptions& o, const core::Pose& T_world_start, core::Random random)
    : options_(o), random_(random), last_position_(T_world_start.position) {}

core::PoseSample PoseSensor::sample(core::TimeNs stamp, const core::Pose& T_world_body) {
  const double path_m = (T_world_body.position - last_position_).norm();
  last_position_ = T_world_body.position;
  const double step = std::sqrt(path_m / kDriftPath_m);
  // The option is the length of the drift vector, so each of three components has 1 / sqrt(3) of it.
  const double drift_m = options_.drift_percent / 100 * kDriftPath_m / std::sqrt(3.0);
  drift_ += drift_m * step * normal_vector(random_);
  heading_drift_ += options_.heading_drift_rad * step * random_.normal();

  const Vec3 noise = options_.noise_m * normal_vector(random_);
  const Vec3 tilt = 0.5 * options_.noise_rad * normal_vector(random_);
  const Quat wobble = Quat(1, tilt.x(), tilt.y(), tilt.z()).normalized();
  const core::Pose measured{
      T_world_body.position + drift_ + noise,
      (core::from_heading(heading_drift_) * T_world_body.orientation * wobble).normalized()};
  return {stamp, measured};
}

}  // namespace karst::sim
