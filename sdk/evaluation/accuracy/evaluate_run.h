// What `karst evaluate` finds out about a run: evaluation.json. docs/evaluate.md
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "sdk/evaluation/accuracy/trajectory_error.h"

namespace karst::evaluation {

struct EvaluateOptions {
  bool align = true, scale = false;
  double max_difference_s = 0.02;  // between stamps that count as the same moment
  double delta_m = 1;              // of the relative error by distance
  std::int64_t delta_frames = 1;
  /// The truth may be in a frame of its own: for drift and heading, which have no best fit, the first poses
  /// are laid on each other.
  bool own_frame = false;
  double time_origin_s = 0;  // stamp of the run's moment 0
};

/// Trajectory errors: numbers below "ape", "rpe", "drift", "heading_error_rad", curves below "plots".
/// Throws InputError naming `truth_file` if no stamps match.
nlohmann::ordered_json trajectory_evaluation(const std::vector<StampedPose>& truth,
                                             const std::vector<StampedPose>& estimate,
                                             const EvaluateOptions& options, const std::string& truth_file);

/// The reference of a map and how a point's distance to it is found.
struct MapReference {
  std::string file;
  std::string kind;  // "mesh" or "cloud"
  std::size_t points = 0;
  std::optional<double> density_per_m2;  // of the points on a mesh
  std::function<double(const core::Vec3&)> distance_m;
};
nlohmann::ordered_json map_evaluation(const std::vector<core::Vec3>& points, const MapReference& reference);

/// Poses of TUM lines, or of KITTI's (twelve numbers a line, a camera's: x right, y down, z forward), which
/// are turned to x forward, y left, z up and take their stamps, one by one, from `stamps`.
/// Throws InputError if there are none, or if a KITTI file does not hold as many as there are stamps.
std::vector<StampedPose> read_poses(const std::string& file, const std::vector<StampedPose>& stamps,
                                    std::vector<std::string>& problems);

}  // namespace karst::evaluation
