#include "sdk/survey_export/axes.h"

#include <Eigen/Eigenvalues>

namespace karst::survey_export {

using core::Vec3;

Axis axis_of(std::span<const LinePoint> points) {
  Axis axis;
  for (const LinePoint& p : points) axis.place += p.position / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const LinePoint& p : points) {
    const Vec3 off = p.position - axis.place;
    spread += off * off.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);  // eigenvalues in increasing order
  axis.direction = solver.eigenvectors().col(2);
  if (axis.direction.dot(points.back().position - points.front().position) < 0)
    axis.direction = -axis.direction;
  return axis;
}

Vec3 meeting_of(std::span<const Axis> axes, const Vec3& held) {
  constexpr double kHeld = 0.05;
  Eigen::Matrix3d a = kHeld * Eigen::Matrix3d::Identity();
  Vec3 b = kHeld * held;
  for (const Axis& axis : axes) {
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis.direction * axis.direction.transpose();
    a += across;
    b += across * axis.place;
  }
  return a.ldlt().solve(b);
}

}  // namespace karst::survey_export
