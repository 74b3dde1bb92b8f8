// Joins a new path to the committed segment of the old one without a corner. A vehicle must slow down at
// corners, and without this there would be one at every new goal.
#pragma once
#include <functional>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

/// Joins `committed` and `path`, which begins where the former ends. The corner between them is replaced by
/// the longest of a few parabolas tangent to both for which `clear` holds, whose deviation from the corner
/// is at most `max_cut_m`, and for which `can_be_flown` holds of the joined path, and of the plain one with
/// the corner. If there is none the corner stays.
std::vector<Vec3> join_paths(
    const std::vector<Vec3>& committed, const std::vector<Vec3>& path, double max_cut_m,
    const std::function<bool(const Vec3&, const Vec3&)>& clear,
    const std::function<bool(const std::vector<Vec3>& joined, const std::vector<Vec3>& plain)>& can_be_flown);

}  // namespace karst::core
