// The evaluation of a run by `karst evaluate`: evaluation.json. docs/evaluate.md
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "sdk/evaluation/accuracy/trajectory_error.h"

namespace karst::evaluation {

struct EvaluateOptions {
  bool align = true, scale = false;
  double max_difference_s = 0.02;  // greatest difference of stamps that count as simultaneous
  double delta_m = 1;              // path length of the relative error
  std::int64_t delta_frames = 1;
  /// The true trajectory may be in a different frame: drift and heading, which use no best fit, then align
  /// the first poses.
  bool own_frame = false;
  double time_origin_s = 0;  // stamp that corresponds to time 0 of the run
};

/// Trajectory errors: numbers in "ape", "rpe", "drift", "heading_error_rad", curves in "plots". Throws
/// InputError naming `truth_file` if no stamps match.
nlohmann::ordered_json trajectory_evaluation(const std::vector<StampedPose>& truth,
                                             const std::vector<StampedPose>& estimate,
                                             const EvaluateOptions& options, const std::string& truth_file);

/// The reference for a map, and the function that gives a point's distance to it.
struct MapReference {
  std::string file;
  std::string kind;  // "mesh" or "cloud"
  std::size_t points = 0;
  std::optional<double> density_per_m2;  // of the points sampled on a mesh
  std::function<double(const core::Vec3&)> distance_m;
};
nlohmann::ordered_json map_evaluation(const std::vector<core::Vec3>& points, const MapReference& reference);

/// Reads poses in TUM format, or in KITTI format (twelve numbers a line, of a camera: x right, y down, z
/// forward), which are converted to x forward, y left, z up and get their stamps, one by one, from `stamps`.
/// Throws InputError if there are none, or if a KITTI file has another number of poses than there are stamps.
std::vector<StampedPose> read_poses(const std::string& file, const std::vector<StampedPose>& stamps,
                                    std::vector<std::string>& problems);

}  // namespace karst::evaluation
