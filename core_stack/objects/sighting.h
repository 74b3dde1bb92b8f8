// A detection in the world: where one look has the object, and how well.
#pragma once
#include "core_stack/vehicle/object_detection.h"

namespace karst::core {

using Mat3 = Eigen::Matrix3d;

struct Sighting {
  ObjectKind kind = ObjectKind::none;
  Vec3 position = Vec3::Zero();  // world frame
  Mat3 covariance =
      Mat3::Zero();  // m^2, of the look itself: what the vehicle's own pose is off by comes on top
};

/// The covariance is an ellipsoid along the line of sight: the range's variance along it, that of the bearing
/// times the range across it.
Sighting locate(const ObjectDetection& detection, const Pose& T_world_camera);

/// Of two places whose difference has the covariance `S`: the square of Mahalanobis' distance.
double mahalanobis2(const Vec3& difference, const Mat3& S);

}  // namespace karst::core
