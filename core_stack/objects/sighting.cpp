#include "core_stack/objects/sighting.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace karst::core {

Sighting locate(const ObjectDetection& d, const Pose& T_world_camera) {
  constexpr double kMin_m = 0.01;  // no look is better: the covariance stays regular
  const Vec3 u = T_world_camera.orientation * d.direction;
  const double along = std::max(d.range_sigma_m, kMin_m);
  const double across = std::max(d.bearing_sigma_rad * d.range_m, kMin_m);
  const Mat3 sight = u * u.transpose();
  return {d.kind, T_world_camera.position + d.range_m * u,
          along * along * sight + across * across * (Mat3::Identity() - sight)};
}

double mahalanobis2(const Vec3& difference, const Mat3& S) {
  return difference.dot(S.ldlt().solve(difference));
}

}  // namespace karst::core
