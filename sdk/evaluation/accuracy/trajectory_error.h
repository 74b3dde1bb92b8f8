// Errors of an estimated trajectory against the true one, as the evo tool (M. Grupp) defines them, and drift
// as KITTI does. Definitions: docs/evaluate.md.
#pragma once
#include <optional>
#include <vector>

#include "sdk/evaluation/record/poses.h"

namespace karst::evaluation {

/// Two simultaneous poses, each in the frame of its trajectory.
struct PosePair {
  double t_s = 0;  // the estimate's stamp
  core::Pose truth, estimate;
};

/// Associates each pose of the shorter trajectory (the estimate, if both are equally long) with the pose of
/// the other that has the nearest stamp, if that is within `max_difference_s`; in order of time.
std::vector<PosePair> associate(const std::vector<StampedPose>& truth,
                                const std::vector<StampedPose>& estimate, double max_difference_s);

/// For each estimate stamped in [from, to] and within the true trajectory, the true pose interpolated at it.
std::vector<PosePair> paired_with_truth(const std::vector<StampedPose>& truth,
                                        const std::vector<StampedPose>& estimate, double from_s, double to_s);

/// One error per pair: of translation in metres, of rotation (the angle) in radians.
struct PoseErrors {
  std::vector<double> translation_m, rotation_rad;
};

/// Absolute pose errors: of truth^-1 estimate.
PoseErrors absolute_errors(const std::vector<PosePair>& pairs);

struct IndexPair {
  std::size_t from, to;
};
/// Consecutive segments of so many poses: (0, n), (n, 2n), ...
std::vector<IndexPair> pairs_by_frames(std::size_t poses, std::size_t frames);
/// Consecutive segments of the estimated path of at least this length; the first begins where the path has
/// reached the length once, as in evo.
std::vector<IndexPair> pairs_by_path(const std::vector<PosePair>& pairs, double metres);

/// Relative pose errors: of (truth_i^-1 truth_j)^-1 (estimate_i^-1 estimate_j).
PoseErrors relative_errors(const std::vector<PosePair>& pairs, const std::vector<IndexPair>& stretches);

/// Drift over segments of the true path, averaged over all of them (Geiger et al., CVPR 2012): segments of 1
/// to 8 times `unit_m`, starting at every tenth pose.
struct SegmentDrift {
  double unit_m = 0;         // 100, as in KITTI, if the path is at least 800 m long; else 10 or 1
  std::size_t segments = 0;  // 0: the path is shorter than 1 m, or has too few poses
  double translation_percent = 0;
  double rotation_radpm = 0;  // radians per metre
};
SegmentDrift segment_drift(const std::vector<PosePair>& pairs);

/// Length of the polyline through the true positions, metres.
double true_path_m(const std::vector<PosePair>& pairs);
/// Distance between the two positions of the last pair, metres.
std::optional<double> end_error_m(const std::vector<PosePair>& pairs);
/// Root mean square of the wrapped heading differences.
std::optional<double> heading_rms_rad(const std::vector<PosePair>& pairs);

}  // namespace karst::evaluation
