#include "sdk/evaluation/cloud.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace karst::evaluation {
namespace {

using core::CellKey;
using core::Vec3;

/// Merges the spans of each key, and drops flickers.
std::vector<OccupiedSpan> merge(std::vector<OccupiedSpan> spans, std::int32_t flicker_ms) {
  std::erase_if(spans, [&](const OccupiedSpan& s) {
    return s.until_ms != OccupiedSpan::kNever && s.until_ms - s.from_ms < flicker_ms;
  });
  std::sort(spans.begin(), spans.end(), [](const OccupiedSpan& a, const OccupiedSpan& b) {
    return a.key != b.key ? a.key < b.key : a.from_ms < b.from_ms;
  });
  std::vector<OccupiedSpan> merged;
  for (const OccupiedSpan& s : spans) {
    if (merged.empty() || merged.back().key != s.key) {
      merged.push_back(s);
    } else {
      merged.back().until_ms = std::max(merged.back().until_ms, s.until_ms);
    }
  }
  return merged;
}

std::vector<OccupiedSpan> halved(std::vector<OccupiedSpan> spans) {
  for (OccupiedSpan& s : spans) s.key = {s.key.x >> 1, s.key.y >> 1, s.key.z >> 1};
  return merge(std::move(spans), 0);
}

using KeySet = std::unordered_set<CellKey, core::CellKeyHash>;

/// Normal of the plane through the cells nearby: the axis along which they spread least.
Vec3 surface_normal(const KeySet& cells, const CellKey& k) {
  constexpr int kReach = 2;
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double n = 0;
  for (int dz = -kReach; dz <= kReach; ++dz)
    for (int dy = -kReach; dy <= kReach; ++dy)
      for (int dx = -kReach; dx <= kReach; ++dx) {
        if (!cells.contains(k + CellKey{dx, dy, dz})) continue;
        const Vec3 d(dx, dy, dz);
        sum += d;
        squares += d * d.transpose();
        n += 1;
      }
  const Eigen::Matrix3d covariance = squares / n - (sum / n) * (sum / n).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  return solver.eigenvectors().col(0);
}

}  // namespace

Cloud make_cloud(const std::vector<OccupiedSpan>& growth, double resolution_m, std::size_t max_points,
                 const std::vector<StampedPose>& seen_from, std::int32_t flicker_ms) {
  Cloud cloud{resolution_m, merge(growth, flicker_ms), {}};
  while (cloud.points.size() > max_points) {
    cloud.points = halved(std::move(cloud.points));
    cloud.cell_m *= 2;
  }
  KeySet cells;
  cells.reserve(cloud.points.size());
  for (const OccupiedSpan& p : cloud.points) cells.insert(p.key);
  for (const OccupiedSpan& p : cloud.points) {
    Vec3 normal = surface_normal(cells, p.key);
    if (!seen_from.empty()) {
      const Vec3 centre = cloud.cell_m * (Vec3(p.key.x, p.key.y, p.key.z) + Vec3::Constant(0.5));
      const Vec3 towards = pose_at(seen_from, p.from_ms * 1e-3).position - centre;
      if (normal.dot(towards) < 0) normal = -normal;
    }
    std::array<std::int8_t, 3> packed{};
    for (int a = 0; a < 3; ++a) packed[a] = static_cast<std::int8_t>(std::lround(127 * normal[a]));
    cloud.normals.push_back(packed);
  }
  return cloud;
}

}  // namespace karst::evaluation
