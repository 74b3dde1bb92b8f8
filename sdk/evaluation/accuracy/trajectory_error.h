// Errors of an estimated trajectory against the true one, as the evo tool (M. Grupp) defines them, and drift
// as KITTI does. Definitions: docs/evaluate.md.
#pragma once
#include <optional>
#include <vector>

#include "sdk/evaluation/record/poses.h"

namespace karst::evaluation {

/// Two poses of the same moment.
struct PosePair {
  double t_s = 0;  // the estimate's stamp
  core::Pose truth, estimate;
};

/// For each pose of the shorter trajectory (the estimate, if both are as long) the one of the other whose
/// stamp is nearest, if it is within `max_difference_s`; in the order of time.
std::vector<PosePair> associate(const std::vector<StampedPose>& truth,
                                const std::vector<StampedPose>& estimate, double max_difference_s);

/// For each estimate stamped in [from, to] and within the truth's time, the truth interpolated at its stamp.
std::vector<PosePair> paired_with_truth(const std::vector<StampedPose>& truth,
                                        const std::vector<StampedPose>& estimate, double from_s, double to_s);

/// One error for each pair: of translation in metres, of rotation (the angle) in radians.
struct PoseErrors {
  std::vector<double> translation_m, rotation_rad;
};

/// Absolute: of truth^-1 estimate.
PoseErrors absolute_errors(const std::vector<PosePair>& pairs);

struct IndexPair {
  std::size_t from, to;
};
/// Consecutive stretches of so many poses: (0, n), (n, 2n), ...
std::vector<IndexPair> pairs_by_frames(std::size_t poses, std::size_t frames);
/// Consecutive stretches of the estimate's path that are at least so long; the first begins where the path
/// has reached the length once, as evo has it.
std::vector<IndexPair> pairs_by_path(const std::vector<PosePair>& pairs, double metres);

/// Relative: of (truth_i^-1 truth_j)^-1 (estimate_i^-1 estimate_j).
PoseErrors relative_errors(const std::vector<PosePair>& pairs, const std::vector<IndexPair>& stretches);

/// Drift over stretches of the true path, averaged over all of them (Geiger et al., CVPR 2012): from every
/// tenth pose on, stretches of 1 to 8 times `unit_m`.
struct SegmentDrift {
  double unit_m = 0;         // 100, as KITTI has it, where the path is 800 m long; else 10 or 1
  std::size_t segments = 0;  // none: the path is shorter than 1 m, or holds too few poses
  double translation_percent = 0;
  double rotation_radpm = 0;  // radians a metre
};
SegmentDrift segment_drift(const std::vector<PosePair>& pairs);

/// Length of the polyline through the true positions.
double true_path_m(const std::vector<PosePair>& pairs);
/// Distance of the two positions of the last pair.
std::optional<double> end_error_m(const std::vector<PosePair>& pairs);
/// Root mean square of the wrapped difference of the headings.
std::optional<double> heading_rms_rad(const std::vector<PosePair>& pairs);

}  // namespace karst::evaluation
