#include "core_stack/mapping/registration/upright_icp.h"

#include <Eigen/Cholesky>

namespace karst::core {
namespace {

constexpr double kLeastCosine = 0.5;  // between the normals of a pair
constexpr std::size_t kLeastPairs = 30;
constexpr double kStill_m = 1e-4;

/// Distances of the points to the planes, linearized: r + n' (t + a z x arm), a turn `a` about the middle.
struct NormalEquations {
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  std::size_t pairs = 0;

  void add(const Vec3& arm, const Vec3& normal, double distance_m) {
    Eigen::Vector4d j;
    j << normal, Vec3::UnitZ().cross(arm).dot(normal);
    A += j * j.transpose();
    b -= distance_m * j;
    ++pairs;
  }
};

Vec3 middle_of_sample(const MapPiece& source, std::size_t stride) {
  Vec3 sum = Vec3::Zero();
  std::size_t count = 0;
  for (std::size_t i = 0; i < source.surface.size(); i += stride, ++count)
    sum += source.surface[i].cast<double>();
  return sum / static_cast<double>(count);
}

}  // namespace

Pose upright_icp(const MapPiece& target, const MapPiece& source, const Pose& T_target_source,
                 const std::vector<IcpRound>& rounds) {
  Pose T = T_target_source;
  for (const IcpRound& round : rounds) {
    const std::size_t stride = (source.surface.size() + round.max_points - 1) / round.max_points;
    const Vec3 middle_in_source = middle_of_sample(source, stride);
    for (int i = 0; i < round.iterations; ++i) {
      const Vec3 middle = T * middle_in_source;
      NormalEquations equations;
      for (std::size_t k = 0; k < source.surface.size(); k += stride) {
        const Vec3 p = T * source.surface[k].cast<double>();
        const auto nearest = target.tree->nearest(p);
        if (!nearest || nearest->distance_m > round.correspondence_m) continue;
        const Vec3 normal = target.normals[nearest->index].cast<double>();
        if (normal.dot(T.orientation * source.normals[k].cast<double>()) < kLeastCosine) continue;
        const Vec3 q = target.tree->points()[nearest->index].cast<double>();
        equations.add(p - middle, normal, normal.dot(p - q));
      }
      if (equations.pairs < kLeastPairs) break;
      // A little damping: along a smooth tube nothing holds the pose.
      equations.A.diagonal() *= 1.001;
      const Eigen::Vector4d step = equations.A.ldlt().solve(equations.b);
      if (!step.allFinite()) break;
      const Quat turn = from_heading(step[3]);
      T = {middle + step.head<3>() + turn * (T.position - middle), (turn * T.orientation).normalized()};
      if (step.head<3>().norm() < kStill_m && std::abs(step[3]) < kStill_m) break;
    }
  }
  return T;
}

}  // namespace karst::core
