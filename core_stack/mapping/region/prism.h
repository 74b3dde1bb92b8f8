// An upright prism: a polygon seen from above, between two heights. World frame, metres.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

using Outline = std::vector<Eigen::Vector2d>;  // corners in either sense; the last is joined to the first

struct Prism {
  Outline outline;
  double low_m = -std::numeric_limits<double>::infinity(), high_m = std::numeric_limits<double>::infinity();
};

/// The prism with two opposite corners `a` and `b`, whose edges are parallel to the axes.
Prism box(const Vec3& a, const Vec3& b);

/// Why a prism is none: too few corners, corners that coincide, edges that cross or touch, no area, or no
/// height. Nothing if it is one.
std::optional<std::string> flaw_of(const Prism& prism);

/// Distance of `p` from the prism's surface: positive inside, negative outside. Exact.
double depth_in(const Prism& prism, const Vec3& p);

}  // namespace karst::core
