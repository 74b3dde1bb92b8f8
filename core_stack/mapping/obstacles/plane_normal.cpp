#include "core_stack/mapping/obstacles/plane_normal.h"

#include <Eigen/Eigenvalues>

namespace karst::core {

Vec3f plane_normal(const std::vector<Vec3f>& points, std::span<const std::uint32_t> chosen,
                   const Vec3f& about) {
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : chosen) {
    const Vec3 d = (points[i] - about).cast<double>();
    sum += d;
    squares += d * d.transpose();
  }
  const auto n = static_cast<double>(chosen.size());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(squares / n - (sum / n) * (sum / n).transpose());
  return solver.eigenvectors().col(0).cast<float>();
}

}  // namespace karst::core
