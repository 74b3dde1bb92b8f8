// Worlds in closed form, and what a LiDAR sees of them.
#pragma once
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "core_stack/common/random.h"
#include "core_stack/common/so3.h"
#include "core_stack/localization/state.h"
#include "core_stack/localization/sweep.h"

namespace karst::test {

using core::Pose;
using core::TimeNs;
using core::Vec3;

/// Distance to the first surface along a unit direction, or infinity.
using World = std::function<double(const Vec3& origin, const Vec3& direction)>;

struct Box {
  Vec3 low, high;
};

/// Where a ray crosses a box's surface: [enter, leave], empty if enter > leave.
inline std::pair<double, double> crossing(const Box& box, const Vec3& origin, const Vec3& direction) {
  double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
  for (int i = 0; i < 3; ++i) {
    const double a = (box.low[i] - origin[i]) / direction[i], b = (box.high[i] - origin[i]) / direction[i];
    enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
  }
  return {enter, leave};
}

/// A hollow box with solid ones in it.
inline World room(const Box& hollow, const std::vector<Box>& solid = {}) {
  return [=](const Vec3& origin, const Vec3& direction) {
    double range = crossing(hollow, origin, direction).second;
    for (const Box& b : solid) {
      const auto [enter, leave] = crossing(b, origin, direction);
      if (enter <= leave && enter > 0) range = std::min(range, enter);
    }
    return range;
  };
}

/// 12 x 9 x 4 m, with two pillars and a step.
inline World furnished_room() {
  return room({{-5, -4, -1.5}, {7, 5, 2.5}},
              {{{2, 2, -2}, {2.6, 2.8, 3}}, {{-3, -2.5, -2}, {-2.2, -2, 3}}, {{4, -4, -2}, {7, -1, -0.9}}});
}

/// Straight along x without an end, of elliptic cross-section.
inline World tube(double half_width_m, double half_height_m) {
  return [=](const Vec3& origin, const Vec3& direction) {
    const Eigen::Vector2d o(origin.y() / half_width_m, origin.z() / half_height_m);
    const Eigen::Vector2d d(direction.y() / half_width_m, direction.z() / half_height_m);
    const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - 1;
    return a < 1e-12 ? std::numeric_limits<double>::infinity() : (-b + std::sqrt(b * b - a * c)) / a;
  };
}

/// Nothing but a level floor.
inline World floor_at(double z) {
  return [=](const Vec3& origin, const Vec3& direction) {
    return direction.z() < -1e-9 ? (z - origin.z()) / direction.z() : std::numeric_limits<double>::infinity();
  };
}

inline std::shared_ptr<core::LidarModel> lidar(int channels, int columns, double half_fov_deg = 22.5,
                                               double max_range_m = 60) {
  auto model = std::make_shared<core::LidarModel>();
  model->columns = columns;
  model->max_range_m = static_cast<float>(max_range_m);
  for (int i = 0; i < channels; ++i)
    model->elevation_rad.push_back(
        static_cast<float>(half_fov_deg * (1 - 2.0 * i / (channels - 1)) * std::numbers::pi / 180));
  model->T_body_lidar = {{0.05, -0.02, 0.1}, core::exp_so3({0, 0.02, 0.3})};
  return model;
}

/// T_world_body at a time.
using Motion = std::function<Pose(TimeNs)>;
inline Motion standing_at(const Pose& pose) {
  return [pose](TimeNs) { return pose; };
}

/// The scan that ends at `stamp`, each column seen from where the vehicle was then.
inline core::LidarScan scan_of(const World& world, const std::shared_ptr<core::LidarModel>& model,
                               const Motion& T_world_body, TimeNs stamp, double noise_m,
                               core::Random random) {
  const auto columns = static_cast<std::size_t>(model->columns);
  core::LidarScan scan{stamp, model, {}, {}};
  scan.range_m.resize(columns * model->elevation_rad.size());
  scan.intensity.assign(scan.range_m.size(), 0.5f);
  for (std::size_t j = 0; j < columns; ++j) {
    const TimeNs fired = stamp - model->period + model->period * static_cast<TimeNs>(j + 1) / model->columns;
    const Pose T = T_world_body(fired) * model->T_body_lidar;
    for (int c = 0; c < model->channels(); ++c) {
      const Vec3 d = model->direction(c, static_cast<int>(j)).cast<double>();
      const double range = world(T.position, T.orientation * d);
      scan.range_m[static_cast<std::size_t>(c) * columns + j] =
          range < model->max_range_m ? static_cast<float>(range + noise_m * random.normal())
                                     : std::numeric_limits<float>::infinity();
    }
  }
  return scan;
}

inline core::Sweep sweep_of(const World& world, const std::shared_ptr<core::LidarModel>& model,
                            const Motion& motion, TimeNs stamp, double noise_m = 0, std::uint64_t seed = 1) {
  return core::to_sweep(scan_of(world, model, motion, stamp, noise_m, core::Random(seed)), 0.2);
}

/// States every 5 ms of the motion moved by `error`, over the 200 ms before `stamp`.
inline core::StateHistory states_of(const Motion& motion, TimeNs stamp, const Pose& error = {}) {
  core::StateHistory history;
  for (TimeNs t = stamp - 200 * core::kMillisecond; t <= stamp; t += 5 * core::kMillisecond) {
    core::State s;
    s.stamp = t;
    const Pose pose = motion(t) * error;
    s.position = pose.position, s.orientation = pose.orientation;
    const Pose later = motion(t + core::kMillisecond) * error;
    s.velocity_mps = 1000 * (later.position - pose.position);
    s.body_rate_radps = 1000 * core::log_so3((pose.orientation.conjugate() * later.orientation).normalized());
    history.push(s);
  }
  return history;
}

struct PoseError {
  double position_m, angle_rad;
};
inline PoseError error_between(const Pose& a, const Pose& b) {
  return {(a.position - b.position).norm(),
          core::log_so3((a.orientation.conjugate() * b.orientation).normalized()).norm()};
}

}  // namespace karst::test
