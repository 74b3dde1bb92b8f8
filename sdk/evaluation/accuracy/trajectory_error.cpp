#include "sdk/evaluation/accuracy/trajectory_error.h"

#include <algorithm>
#include <cmath>

namespace karst::evaluation {
namespace {

using core::Pose;

constexpr std::size_t kSegmentStep = 10;  // KITTI: one second of its frames
constexpr int kSegmentLengths = 8;

/// The pose with the stamp nearest to `t_s`, the earlier of two. Null if the difference exceeds the maximum.
const StampedPose* nearest(const std::vector<StampedPose>& poses, double t_s, double max_difference_s) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), t_s,
                                      [](const StampedPose& p, double t) { return p.t_s < t; });
  const StampedPose* best = nullptr;
  if (after != poses.end()) best = &*after;
  if (after != poses.begin()) {
    const StampedPose& before = *(after - 1);
    if (!best || t_s - before.t_s <= best->t_s - t_s) best = &before;
  }
  return best && std::abs(best->t_s - t_s) <= max_difference_s ? best : nullptr;
}

void add_error(const Pose& error, PoseErrors& errors) {
  errors.translation_m.push_back(error.position.norm());
  // 2 atan2(|v|, |w|): the acos of a trace loses half its digits near no rotation.
  errors.rotation_rad.push_back(2 *
                                std::atan2(error.orientation.vec().norm(), std::abs(error.orientation.w())));
}

Pose relative_error(const PosePair& i, const PosePair& j) {
  return (i.truth.inverse() * j.truth).inverse() * (i.estimate.inverse() * j.estimate);
}

std::vector<double> true_lengths(const std::vector<PosePair>& pairs) {
  std::vector<double> length_m(pairs.size(), 0.0);
  for (std::size_t i = 1; i < pairs.size(); ++i)
    length_m[i] = length_m[i - 1] + (pairs[i].truth.position - pairs[i - 1].truth.position).norm();
  return length_m;
}

}  // namespace

std::vector<PosePair> associate(const std::vector<StampedPose>& truth,
                                const std::vector<StampedPose>& estimate, double max_difference_s) {
  std::vector<PosePair> pairs;
  const bool estimate_longer = estimate.size() > truth.size();
  for (const StampedPose& p : estimate_longer ? truth : estimate) {
    const StampedPose* other = nearest(estimate_longer ? estimate : truth, p.t_s, max_difference_s);
    if (!other) continue;
    const StampedPose& e = estimate_longer ? *other : p;
    pairs.push_back({e.t_s, (estimate_longer ? p : *other).T_world_body, e.T_world_body});
  }
  return pairs;
}

std::vector<PosePair> paired_with_truth(const std::vector<StampedPose>& truth,
                                        const std::vector<StampedPose>& estimate, double from_s,
                                        double to_s) {
  std::vector<PosePair> pairs;
  if (truth.empty()) return pairs;
  for (const StampedPose& e : estimate)
    if (e.t_s >= std::max(from_s, truth.front().t_s) && e.t_s <= std::min(to_s, truth.back().t_s))
      pairs.push_back({e.t_s, pose_at(truth, e.t_s), e.T_world_body});
  return pairs;
}

PoseErrors absolute_errors(const std::vector<PosePair>& pairs) {
  PoseErrors errors;
  for (const PosePair& p : pairs) add_error(p.truth.inverse() * p.estimate, errors);
  return errors;
}

std::vector<IndexPair> pairs_by_frames(std::size_t poses, std::size_t frames) {
  std::vector<IndexPair> stretches;
  for (std::size_t i = 0; frames > 0 && i + frames < poses; i += frames) stretches.push_back({i, i + frames});
  return stretches;
}

std::vector<IndexPair> pairs_by_path(const std::vector<PosePair>& pairs, double metres) {
  std::vector<IndexPair> stretches;
  std::optional<std::size_t> begin;
  double length_m = 0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    length_m += (pairs[i].estimate.position - pairs[i - 1].estimate.position).norm();
    if (length_m < metres) continue;
    if (begin) stretches.push_back({*begin, i});
    begin = i;
    length_m = 0;
  }
  return stretches;
}

PoseErrors relative_errors(const std::vector<PosePair>& pairs, const std::vector<IndexPair>& stretches) {
  PoseErrors errors;
  for (const IndexPair& s : stretches) add_error(relative_error(pairs[s.from], pairs[s.to]), errors);
  return errors;
}

SegmentDrift segment_drift(const std::vector<PosePair>& pairs) {
  SegmentDrift drift;
  const std::vector<double> length_m = true_lengths(pairs);
  const double whole_m = length_m.empty() ? 0 : length_m.back();
  drift.unit_m = whole_m >= 800 ? 100 : whole_m >= 80 ? 10 : 1;
  for (std::size_t i = 0; i < pairs.size(); i += kSegmentStep)
    for (int k = 1; k <= kSegmentLengths; ++k) {
      const double segment_m = k * drift.unit_m;
      const auto end = std::upper_bound(length_m.begin(), length_m.end(), length_m[i] + segment_m);
      if (end == length_m.end()) break;
      PoseErrors error;
      add_error(relative_error(pairs[i], pairs[static_cast<std::size_t>(end - length_m.begin())]), error);
      drift.translation_percent += 100 * error.translation_m.front() / segment_m;
      drift.rotation_radpm += error.rotation_rad.front() / segment_m;
      ++drift.segments;
    }
  if (drift.segments == 0) return drift;
  drift.translation_percent /= static_cast<double>(drift.segments);
  drift.rotation_radpm /= static_cast<double>(drift.segments);
  return drift;
}

double true_path_m(const std::vector<PosePair>& pairs) {
  return pairs.empty() ? 0 : true_lengths(pairs).back();
}

std::optional<double> end_error_m(const std::vector<PosePair>& pairs) {
  if (pairs.empty()) return std::nullopt;
  return (pairs.back().estimate.position - pairs.back().truth.position).norm();
}

std::optional<double> heading_rms_rad(const std::vector<PosePair>& pairs) {
  if (pairs.empty()) return std::nullopt;
  double squares = 0;
  for (const PosePair& p : pairs) {
    const double error =
        core::wrap_angle(core::heading_of(p.estimate.orientation) - core::heading_of(p.truth.orientation));
    squares += error * error;
  }
  return std::sqrt(squares / static_cast<double>(pairs.size()));
}

}  // namespace karst::evaluation
