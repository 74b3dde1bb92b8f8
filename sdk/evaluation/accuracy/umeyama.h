// Least-squares similarity transform between two point sets. Umeyama, IEEE PAMI 13(4), 1991.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::evaluation {

/// to = scale * R * from + t.
struct Similarity {
  double scale = 1;
  core::Pose T_to_from;  // R and t

  core::Vec3 operator*(const core::Vec3& p) const {
    return T_to_from.position + scale * (T_to_from.orientation * p);
  }
  /// Transforms a body's pose: the scale acts on its position, not on the body itself.
  core::Pose operator*(const core::Pose& T) const {
    return {*this * T.position, (T_to_from.orientation * T.orientation).normalized()};
  }
};

/// Minimizes the sum of |to_i - (scale R from_i + t)|^2. None for fewer than three pairs, or for collinear
/// (or coincident) points, which do not determine the rotation.
std::optional<Similarity> umeyama(const std::vector<core::Vec3>& from, const std::vector<core::Vec3>& to,
                                  bool with_scale);

}  // namespace karst::evaluation
