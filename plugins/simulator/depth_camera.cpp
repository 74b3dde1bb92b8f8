#include "plugins/simulator/depth_camera.h"

#include <algorithm>
#include <numbers>

#include "plugins/simulator/range_noise.h"

namespace karst::sim {

using core::Quat;
using core::Vec3;

void describe(core::OptionTable& t, CameraOptions& o) {
  t.add("rate", o.rate_hz, "Hz", 1, 50, "images a second, rounded to whole steps of 5 ms");
  t.add("noise", o.noise_at_1m_m, "m", 0, 0.2,
        "standard deviation at 1 m; grows with the square of the range");
}

std::shared_ptr<const core::CameraModel> camera_model(const CameraOptions& o, Facing facing) {
  constexpr double kDegree = std::numbers::pi / 180;
  auto m = std::make_shared<core::CameraModel>();
  m->period = core::from_seconds(std::max(std::round(200 / o.rate_hz), 1.0) * 0.005);
  if (facing == Facing::forward) {
    m->name = "forward";
    m->width = 80, m->height = 64;
    m->horizontal_fov_rad = 79 * kDegree, m->vertical_fov_rad = 64 * kDegree;
    m->max_range_m = 4.5f;
    m->T_body_camera.position = {0.15, 0, 0};
    return m;
  }
  m->width = 80, m->height = 56;
  m->horizontal_fov_rad = 86 * kDegree, m->vertical_fov_rad = 58 * kDegree;
  m->max_range_m = 5.0f;
  const double up = facing == Facing::up ? 1 : -1;
  m->name = facing == Facing::up ? "up" : "down";
  m->T_body_camera.position = {0, 0, 0.1 * up};
  // The optical axis (camera x) along body z: a quarter turn about y.
  m->T_body_camera.orientation = Quat(Eigen::AngleAxisd(-up * std::numbers::pi / 2, Vec3::UnitY()));
  return m;
}

DepthCamera::DepthCamera(const CameraOptions& o, std::shared_ptr<const core::CameraModel> model)
    : options_(o), model_(std::move(model)) {
  for (int row = 0; row < model_->height; ++row)
    for (int column = 0; column < model_->width; ++column) beams_.push_back(model_->direction(row, column));
}

core::DepthImage DepthCamera::image(const cave::Cave& cave, const core::Pose& T_world_body,
                                    core::TimeNs stamp, core::Random random) const {
  const core::Pose T_world_camera = T_world_body * model_->T_body_camera;
  const Eigen::Matrix3f R = T_world_camera.orientation.toRotationMatrix().cast<float>();
  std::vector<cave::Ray> rays(beams_.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays[i] = {T_world_camera.position.cast<float>(), R * beams_[i]};
  std::vector<cave::Hit> hits(rays.size());
  cave.scene.cast(rays, model_->max_range_m, hits);

  core::DepthImage image{stamp, model_, std::vector<float>(rays.size())};
  const auto noise = static_cast<float>(options_.noise_at_1m_m);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    float range = hits[i].range_m;
    if (hits[i].any()) range += noise * range * range * range_noise(random);
    if (range < model_->min_range_m) range = std::numeric_limits<float>::quiet_NaN();
    image.range_m[i] = range;
  }
  return image;
}

}  // namespace karst::sim
