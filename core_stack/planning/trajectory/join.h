// Joining a new path to the stretch of an old one that leads to its beginning, without a corner: a corner has
// to be slowed down for, and in flight there is one at every new goal.
#pragma once
#include <functional>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

/// `lead` and then `path`, which begins where the lead ends. The corner between them is replaced by a
/// parabola that touches both, the longest of a few for which `clear` holds along it and which passes the
/// corner by no more than `max_cut_m`; without one it stays.
std::vector<Vec3> join_paths(const std::vector<Vec3>& committed, const std::vector<Vec3>& path,
                             double max_cut_m, const std::function<bool(const Vec3&, const Vec3&)>& clear);

}  // namespace karst::core
