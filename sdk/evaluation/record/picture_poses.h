// True poses of the colour camera at its pictures: the simulator's ground_truth_frames.csv.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::evaluation {

struct PicturePose {
  double t_s = 0;
  core::Pose T_world_camera;  // x along the optical axis, y left, z up
  double tan_half_width = 0, tan_half_height = 0;
  double min_range_m = 0, max_range_m = 0;  // rock within this range is lit and sharp
  double max_incidence_rad = 0;
};

/// A missing file gives none: there was no camera. Unreadable lines are left out and added to `problems`.
std::vector<PicturePose> read_picture_poses(const std::filesystem::path& file,
                                            std::vector<std::string>& problems);

}  // namespace karst::evaluation
