// Time-stamped poses in the TUM format: lines "t x y z qx qy qz qw", in seconds and metres.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::evaluation {

struct StampedPose {
  double t_s = 0;
  core::Pose T_world_body;
};

/// In order of time. Lines that start with # are comments; malformed lines are left out and reported.
std::vector<StampedPose> read_tum(const std::filesystem::path& file, std::vector<std::string>& problems);

/// A line of such a file; none if it is malformed.
std::optional<StampedPose> pose_of_line(const std::string& line);

/// See core::pose_on_track; `poses` must not be empty.
core::Pose pose_at(const std::vector<StampedPose>& poses, double t_s);

/// Length in metres of the polyline through the poses stamped within [from, to].
double path_length_m(const std::vector<StampedPose>& poses, double from_s, double to_s);

}  // namespace karst::evaluation
