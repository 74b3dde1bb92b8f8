#include "core_stack/localization/loam.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/so3.h"

namespace karst::core {

void describe(OptionTable& t, LoamOptions& o) {
  t.section("features", o.features);
  t.section("map", o.map);
  t.section("registration", o.registration);
  t.add("scan_to_scan", o.scan_to_scan, {"auto", "always", "never"},
        "align each sweep with the one before first; auto: where the prediction does not cover it");
  t.add("keyframe_distance", o.keyframe_distance_m, "m", 0.05, 20,
        "a sweep joins the map if it was taken so far from all that did");
  t.add("keyframe_matched_share", o.keyframe_matched_share, "", 0, 1,
        "or if a smaller share of its features lies on surfaces of the map");
  t.add("threads", o.threads, 1, 64, "results do not depend on it");
}

Loam::Loam(const LoamOptions& options, const Pose& T_world_start)
    : options_(options),
      edge_level_(options.map.voxel_m, options.map.max_points),
      fine_level_(options.map.voxel_m, options.map.max_points),
      coarse_level_(options.map.coarse_voxel_m, options.map.max_points),
      T_world_last_(T_world_start) {}

Loam::Guess Loam::guess_for(const Sweep& sweep, const StateHistory& predicted, double length_s) const {
  Guess g;
  const auto end = predicted_pose(predicted, sweep.stamp);
  const auto begin = predicted_pose(predicted, sweep.stamp - from_seconds(length_s));
  if (end && begin) {
    g.T_world_body = *end;
    g.covered = true;
    return g;
  }
  g.twist = twist_;
  const double dt_s = last_valid_stamp_ ? seconds(sweep.stamp - *last_valid_stamp_) : 0;
  g.T_world_body = T_world_last_ * pose_after(twist_, std::min(dt_s, 1.0));
  return g;
}

SweepMotion Loam::motion_of(const Sweep& sweep, const StateHistory& predicted, const Guess& g,
                            double length_s) const {
  if (sweep.compensated) return {0, sweep.T_body_lidar, [](double) { return Pose{}; }};
  const Pose T_end_world = g.T_world_body.inverse();
  return {length_s, sweep.T_body_lidar, [&](double time_s) {
            return g.covered ? T_end_world * *predicted_pose(predicted, sweep.stamp + from_seconds(time_s))
                             : pose_after(g.twist, time_s);
          }};
}

LoamPose Loam::process(const Sweep& input, const StateHistory& predicted) {
  LoamPose out;
  out.stamp = input.stamp;
  out.T_world_body = T_world_last_;
  const auto refuse = [&](const std::string& why) {
    out.problem = why;
    return out;
  };
  if (last_stamp_ && input.stamp <= *last_stamp_) return refuse("the sweep is not newer than the last");

  Sweep sweep = input;
  std::erase_if(sweep.points, [](const SweepPoint& p) {
    return !p.position.allFinite() || !std::isfinite(p.time_s) || p.position.squaredNorm() < 1e-4f ||
           p.time_s < -1 || p.time_s > 0;
  });
  double length_s = 0;
  for (const SweepPoint& p : sweep.points) length_s = std::max(length_s, static_cast<double>(-p.time_s));
  last_stamp_ = sweep.stamp;
  const Guess guess = guess_for(sweep, predicted, length_s);
  out.T_world_body = guess.T_world_body;

  const int threads = static_cast<int>(options_.threads);
  const Features features = find_features(sweep.points, options_.features, threads);
  if (static_cast<std::int64_t>(features.planes.size() + features.edges.size()) <
      options_.registration.min_matches)
    return refuse("too few features: " + std::to_string(features.planes.size()) + " planes and " +
                  std::to_string(features.edges.size()) + " edges in " + std::to_string(sweep.points.size()) +
                  " points");
  const SweepMotion motion = motion_of(sweep, predicted, guess, length_s);

  if (fine_level_.blocks() == 0) {
    out.valid = true;
    last_valid_stamp_ = sweep.stamp;
    T_world_last_ = out.T_world_body;
    insert(sweep, features, motion, out.T_world_body);
    return out;
  }
  Cloud cloud;
  for (const Feature& f : features.edges) cloud.edges.push_back(motion.to_body_at_end(f.position, f.time_s));
  for (const Feature& f : features.planes)
    cloud.planes.push_back(motion.to_body_at_end(f.position, f.time_s));
  const Fit fit = fit_to_map(cloud, {&edge_level_, &fine_level_, &coarse_level_}, guess.T_world_body,
                             options_.registration, options_.registration.max_distance_m, threads);
  out.edges = fit.edges, out.planes = fit.planes;
  out.rms_residual_m = fit.rms_residual_m;
  out.covariance = fit.covariance;
  out.free_directions = fit.free_directions;
  if (!fit.converged) return refuse("too few features lie on surfaces of the local map");
  if (fit.matched_share < options_.registration.min_matched_share)
    return refuse("the sweep does not overlap with the local map");

  out.valid = true;
  out.T_world_body = fit.T_world_body;
  if (last_valid_stamp_)
    twist_ = twist_between(T_world_last_, fit.T_world_body, seconds(sweep.stamp - *last_valid_stamp_));
  last_valid_stamp_ = sweep.stamp;
  T_world_last_ = fit.T_world_body;
  if (is_keyframe(fit.T_world_body.position, fit.matched_share))
    insert(sweep, features, motion, fit.T_world_body);
  return out;
}

bool Loam::is_keyframe(const Vec3& position, double matched_share) const {
  if (matched_share < options_.keyframe_matched_share) return true;
  return std::none_of(keyframes_.begin(), keyframes_.end(),
                      [&](const Vec3& k) { return (k - position).norm() < options_.keyframe_distance_m; });
}

void Loam::insert(const Sweep& sweep, const Features& features, const SweepMotion& motion,
                  const Pose& T_world_body) {
  const Eigen::Matrix3f R = T_world_body.orientation.toRotationMatrix().cast<float>();
  const Vec3f t = T_world_body.position.cast<float>();
  const auto to_world = [&](const Vec3f& p, float time_s) -> Vec3f {
    return R * motion.to_body_at_end(p, time_s) + t;
  };
  std::vector<Vec3f> edges, surface;
  for (const Feature& f : features.edges) edges.push_back(to_world(f.position, f.time_s));
  for (const std::uint32_t i : features.surface)
    surface.push_back(to_world(sweep.points[i].position, sweep.points[i].time_s));
  edge_level_.insert(edges);
  fine_level_.insert(surface);
  coarse_level_.insert(surface);
  const auto max_blocks = static_cast<std::size_t>(options_.map.max_blocks);
  for (VoxelLevel* level : {&edge_level_, &fine_level_, &coarse_level_})
    level->roll(T_world_body.position, options_.map.radius_m, max_blocks);
  std::erase_if(keyframes_, [&](const Vec3& k) {
    return (k - T_world_body.position).cwiseAbs().maxCoeff() > options_.map.radius_m;
  });
  keyframes_.push_back(T_world_body.position);
}

std::size_t Loam::map_bytes() const {
  return edge_level_.bytes() + fine_level_.bytes() + coarse_level_.bytes();
}
std::size_t Loam::map_voxels() const {
  return edge_level_.voxels() + fine_level_.voxels() + coarse_level_.voxels();
}

}  // namespace karst::core
