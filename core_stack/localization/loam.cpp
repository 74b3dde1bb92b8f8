#include "core_stack/localization/loam.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/so3.h"
#include "core_stack/localization/unordered_features.h"

namespace karst::core {
namespace {

constexpr float kNearest = 0.01f, kFarthest = 1000;  // m: points nearer or farther are not valid measurements
constexpr float kLongest = 1;                        // s: the longest possible sweep
constexpr double kHeld = 1;                          // s: the longest time for which a velocity is held
constexpr int kRefinements = 2;                      // of a sweep's motion if there is no prediction
constexpr double kSameMotion = 0.01;                 // m: if the motion changes less, the sweep is kept
constexpr double kRockDistance = 5;                  // m: range at which the effect of a rotation is measured
constexpr double kNearlyAll = 0.7;                   // of a sweep's features on the map
constexpr double kBraking = 0.5;                     // s of flight: the way in which it brakes
constexpr double kLongGap = 0.5;                     // s without a pose, after which a prediction is weak

bool is_measurement(const SweepPoint& p) {
  const float range2 = p.position.squaredNorm();  // comparisons with NaN are false
  return range2 > kNearest * kNearest && range2 < kFarthest * kFarthest && p.time_s <= 0 &&
         p.time_s > -kLongest;
}

double length_of(const Sweep& sweep) {
  float longest = 0;
  if (!sweep.compensated)
    for (const SweepPoint& p : sweep.points) longest = std::max(longest, -p.time_s);
  return static_cast<double>(longest);
}

FeatureOptions halved(FeatureOptions o) {
  o.plane_sectors = std::max<std::int64_t>(1, o.plane_sectors / 2);
  o.edge_sectors = std::max<std::int64_t>(1, o.edge_sectors / 2);
  return o;
}

Cloud compensated(const Features& features, const SweepMotion& motion) {
  const auto moved = [&](const std::vector<Feature>& from) {
    std::vector<Vec3f> to(from.size());
    std::transform(from.begin(), from.end(), to.begin(),
                   [&](const Feature& f) { return motion.to_body_at_end(f.position, f.time_s); });
    return to;
  };
  return {moved(features.edges), moved(features.planes), moved(features.surface)};
}

/// A few matches tell less of the height than an IMU does, but more than the velocity of the last sweep.
RegistrationOptions without_imu(RegistrationOptions o) {
  o.degenerate_fraction_vertical = o.degenerate_fraction;
  return o;
}

/// Distance between the first points of a sweep under two assumed motions.
double moved_within(double length_s, const Twist& a, const Twist& b) {
  return length_s *
         ((a.velocity_mps - b.velocity_mps).norm() + kRockDistance * (a.rate_radps - b.rate_radps).norm());
}

std::string counted(std::size_t n, const char* what) { return std::to_string(n) + " " + what; }

}  // namespace

void describe(OptionTable& t, LoamOptions& o) {
  t.section("features", o.features);
  t.section("map", o.map);
  t.section("registration", o.registration);
  t.add("scan_to_scan", o.scan_to_scan,
        "fit each sweep to the one before first; auto: where the prediction does not cover it");
  t.add("max_correction", o.max_correction_m, "m", 0.05, 20, "a fit farther from its guess is not believed");
  t.add("max_correction_angle", o.max_correction_rad, "rad", 0.01, 3.1, "nor one turned by more");
  t.add(
      "restart", o.restart_s, "s", 0.5, 1000,
      "without a valid pose for so long a sweep that does not lie on the local map begins another, where the "
      "vehicle is predicted to be");
  t.add("threads", o.threads, 1, 64, "that share the work; results do not depend on it");
}

Loam::Loam(const LoamOptions& options, const Pose& T_world_start)
    : options_(options),
      map_(options.map),
      last_sweep_(options.map),
      workspace_{static_cast<int>(options.threads), {}},
      T_world_last_(T_world_start) {}

Loam::Prediction Loam::predict(const Sweep& sweep, double length_s, const StateHistory& states) const {
  const std::optional<Pose> end = predicted_pose(states, sweep.stamp);
  if (end && predicted_pose(states, sweep.stamp - from_seconds(length_s))) return {true, *end, {}};
  const double since_s = last_valid_ ? seconds(sweep.stamp - *last_valid_) : 0;
  return {false, T_world_last_ * pose_after(twist_, std::min(since_s, kHeld)), twist_};
}

LoamPose Loam::process(const Sweep& sweep, const StateHistory& predicted, LoamEffort effort) {
  if (last_stamp_ && sweep.stamp <= *last_stamp_) {
    LoamPose refused;
    refused.stamp = sweep.stamp;
    refused.T_world_body = T_world_last_;
    refused.problem = "the sweep is not newer than the last one";
    return refused;
  }
  last_stamp_ = sweep.stamp;
  if (!last_valid_) last_valid_ = sweep.stamp;
  if (std::all_of(sweep.points.begin(), sweep.points.end(), is_measurement))
    return locate(sweep, predicted, effort);
  Sweep clean = sweep;
  std::erase_if(clean.points, [](const SweepPoint& p) { return !is_measurement(p); });
  return locate(clean, predicted, effort);
}

LoamPose Loam::begin_map(const Cloud& cloud, LoamPose pose, bool bent) {
  map_.clear();
  pose.valid = true;
  accept(pose, cloud);
  first_is_bent_ = bent;
  return pose;
}

LoamPose Loam::locate(const Sweep& sweep, const StateHistory& states, LoamEffort effort) {
  const double length_s = length_of(sweep), since_s = seconds(sweep.stamp - *last_valid_);
  const Prediction prediction = predict(sweep, length_s, states);
  LoamPose out;
  out.stamp = sweep.stamp;
  out.T_world_body = prediction.T_world_body;

  const bool full = effort == LoamEffort::full;
  const Features features =
      sweep.has_rings
          ? find_features(sweep.points, full ? options_.features : halved(options_.features),
                          workspace_.threads)
          : find_unordered_features(sweep.points, options_.features, workspace_.threads, full ? 1.0 : 0.5);
  const std::size_t count = features.edges.size() + features.planes.size();
  if (count < static_cast<std::size_t>(options_.registration.min_matches)) {
    out.problem = "too few features: " + counted(count, "in ") + counted(sweep.points.size(), "points");
    return out;
  }
  const auto cloud_with = [&](const Prediction& p) {
    return compensated(features, SweepMotion(length_s, sweep.T_body_lidar, [&](double time_s) {
                         if (!p.covered) return pose_after(p.twist, time_s);
                         const TimeNs t = sweep.stamp + from_seconds(time_s);
                         return p.T_world_body.inverse() * predicted_pose(states, t).value_or(p.T_world_body);
                       }));
  };
  Cloud cloud = cloud_with(prediction);
  const bool bent = !prediction.covered && !sweep.compensated;
  if (map_.empty()) return begin_map(cloud, out, bent);
  LoamPose anew = out;

  const std::size_t coarsest = map_.surfaces().size() - 1;
  const bool weak = !prediction.covered || since_s > kLongGap || gap_;
  const RegistrationOptions registration = weak ? without_imu(options_.registration) : options_.registration;
  const auto fit = [&](const LocalMap& map, const Pose& guess, std::size_t first_level) {
    return fit_to_map(cloud, map, guess, first_level, registration, workspace_);
  };
  const bool scan_to_scan =
      options_.scan_to_scan == ScanToScan::always || (options_.scan_to_scan == ScanToScan::automatic && weak);
  Pose guess = prediction.T_world_body;
  if (scan_to_scan && !last_sweep_.empty()) {
    const Fit with_last = fit(last_sweep_, guess, coarsest);
    if (with_last.good) guess = with_last.T_world_body;
  }
  Fit found = fit(map_, guess, weak ? coarsest : 0);
  // What nobody saw may have been flown as predicted; or the vehicle braked, and nearly all is where it was.
  Pose expected = prediction.T_world_body;
  if (gap_) {
    for (const double after_s : {0.0, kBraking}) {
      const Pose place = T_world_last_ * pose_after(twist_, after_s);
      const Fit stayed = fit(map_, place, coarsest);
      if (!stayed.good ||
          stayed.matched_fraction <= std::max(kNearlyAll, found.good ? found.matched_fraction : 0))
        continue;
      found = stayed;
      expected = place;
    }
  }
  // Without a prediction the last velocity compensated the sweep. The fit gives a better one: refine.
  const int refinements = prediction.covered || gap_ || since_s <= 0 ? 0 : first_is_bent_ ? 1 : kRefinements;
  Twist assumed = prediction.twist;
  for (int i = 0; i < refinements && found.good; ++i) {
    const Twist twist = twist_between(T_world_last_, found.T_world_body, since_s);
    if (moved_within(length_s, twist, assumed) < kSameMotion) break;
    assumed = twist;
    cloud = cloud_with({false, found.T_world_body, twist});
    found = fit(map_, found.T_world_body, 0);
  }

  out.edges = found.edges;
  out.planes = found.planes;
  out.rms_residual_m = found.rms_residual_m;
  out.covariance = found.covariance;
  out.free_directions = found.free_directions;
  const Pose correction = expected.inverse() * found.T_world_body;
  const bool far = correction.position.norm() > options_.max_correction_m ||
                   log_so3(correction.orientation).norm() > options_.max_correction_rad;
  if (!found.good) {
    const auto matched = static_cast<std::size_t>(found.edges) + static_cast<std::size_t>(found.planes);
    out.problem = "the sweep does not lie on the local map: " + counted(matched, "of ") +
                  counted(count, "features match");
  } else if (far) {
    out.problem = "the fit lies too far from the prediction";
  } else {
    out.valid = true;
    out.T_world_body = found.T_world_body;
    accept(out, cloud);
    if (scan_to_scan) last_sweep_.insert(transformed(out.T_world_body, cloud), out.T_world_body.position);
  }
  if (!out.valid && since_s > options_.restart_s) {
    anew.anew = true;
    anew.problem = "the local map began anew where the vehicle was predicted to be";
    anew.covariance = 1e4 * Matrix6::Identity();  // (100 m)^2: the position is unknown
    return begin_map(cloud_with(prediction), anew, bent);
  }
  return out;
}

void Loam::accept(const LoamPose& pose, const Cloud& cloud) {
  const double dt_s = seconds(pose.stamp - *last_valid_);
  twist_ =
      !gap_ && dt_s > 0 && dt_s < kHeld ? twist_between(T_world_last_, pose.T_world_body, dt_s) : Twist{};
  last_valid_ = pose.stamp;
  gap_ = false;
  T_world_last_ = pose.T_world_body;

  const Vec3& place = pose.T_world_body.position;
  if (first_is_bent_) map_.clear();  // now the velocity is known: this sweep becomes the first of the map
  first_is_bent_ = false;
  if (map_.is_new_place(place)) map_.insert(transformed(pose.T_world_body, cloud), place);
  last_sweep_.clear();
}

}  // namespace karst::core
