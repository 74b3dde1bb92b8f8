// The normal of the plane through some points.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

/// The unit vector along which the chosen points vary least (principal component analysis), of either sign.
/// `about` is a place near them.
Vec3f plane_normal(const std::vector<Vec3f>& points, std::span<const std::uint32_t> chosen,
                   const Vec3f& about);

}  // namespace karst::core
