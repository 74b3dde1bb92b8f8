#include "sdk/evaluation/accuracy/umeyama.h"

#include <Eigen/SVD>

namespace karst::evaluation {

using core::Vec3;

std::optional<Similarity> umeyama(const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                                  bool with_scale) {
  if (from.size() != to.size() || from.size() < 3) return std::nullopt;
  const double n = static_cast<double>(from.size());
  Vec3 from_mean = Vec3::Zero(), to_mean = Vec3::Zero();
  for (const Vec3& p : from) from_mean += p / n;
  for (const Vec3& p : to) to_mean += p / n;

  // Equations 34 to 43: with the singular values D of the covariance U D V^T of the centred points,
  // R = U S V^T, scale = tr(D S) / variance(from), t = mean(to) - scale R mean(from), where S = diag(1, 1,
  // +-1) keeps R from being a reflection.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double variance = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    covariance += (to[i] - to_mean) * (from[i] - from_mean).transpose() / n;
    variance += (from[i] - from_mean).squaredNorm() / n;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3& d = svd.singularValues();
  if (!d.allFinite() || d[1] <= 1e-12 * d[0] || d[0] <= 0) return std::nullopt;
  Vec3 s = Vec3::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) s[2] = -1;

  Similarity found;
  found.T_to_from.orientation =
      core::Quat(Eigen::Matrix3d(svd.matrixU() * s.asDiagonal() * svd.matrixV().transpose())).normalized();
  if (with_scale) found.scale = d.dot(s) / variance;
  found.T_to_from.position = to_mean - found.scale * (found.T_to_from.orientation * from_mean);
  return found;
}

}  // namespace karst::evaluation
