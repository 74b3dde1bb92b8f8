// The LiDAR's rotation against the gyroscope's, while the vehicle is turned by hand: how far the LiDAR is
// turned from where the description says, and how late its stamps are.
//
// Between two scans, the LiDAR turned by r and the gyroscope by g, both rotation vectors in the body frame.
// If the stamps are late by d and the mounting is wrong by the rotation E,
//
//   r_k = E g_k(d),   g_k(d) = log(Q(t_k - d)^-1 Q(t_k+1 - d)),   Q by the gyroscope.
//
// For each d, A = (sum r g') (sum g g')^-1 is the linear map that fits best; the d with the least residual is
// the delay. A is not forced to be a rotation: swapped axes make it a reflection, and a wrong scale changes
// its length. E is the rotation nearest to A. With s^2 the variance of a component of r_k - E g_k, the
// covariance of a small rotation of E is s^2 (sum |g|^2 I - g g')^-1.
#pragma once
#include <optional>
#include <span>

#include "sdk/preflight/vehicle/gyro_track.h"

namespace karst::preflight {

struct HandEye {
  int pairs = 0;       // of scans
  double delay_s = 0;  // of the LiDAR's stamps; positive: late
  double delay_sigma_s = 0;
  double explained = 0;  // 1 - residual / turn, of the squares: near 1, or the two do not agree
  Eigen::Matrix3d map = Eigen::Matrix3d::Identity();  // A
  core::Vec3 error_rad = core::Vec3::Zero();          // rotation vector of E, body frame
  double sigma_rad = 0;                               // of the worst axis of E
  double scale = 1;                                   // mean length of A: LiDAR over gyroscope
  double weakest_rate_radps = 0;                      // root mean square about the axis turned about least
};

/// Nothing if there are too few pairs. `track` is the gyroscope's, `lidar` by scan matching.
std::optional<HandEye> hand_eye(std::span<const Orientation> track, std::span<const Orientation> lidar);

/// The rate of rotation between neighbours, at the second one's stamp.
struct TurnRate {
  core::TimeNs stamp = 0;
  double radps = 0;
};
std::vector<TurnRate> turn_rates(std::span<const Orientation> track);

}  // namespace karst::preflight
