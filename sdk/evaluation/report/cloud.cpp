#include "sdk/evaluation/report/cloud.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace karst::evaluation {
namespace {

using core::CellKey;
using core::Vec3;

/// Merges the spans of each key, and drops short flickers.
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

/// Cells as bits of 4x4x4 blocks, so that the neighbourhood of a cell takes eight look-ups.
class CellBits {
 public:
  explicit CellBits(const std::vector<OccupiedSpan>& points) {
    for (const OccupiedSpan& p : points) blocks_[block_of(p.key)] |= bit_of(p.key);
  }

  /// Calls visit(dx, dy, dz) for the cells within two of `k` in each axis.
  template <class Visit>
  void for_neighbours(const CellKey& k, const Visit& visit) const {
    const CellKey low = block_of(k + CellKey{-2, -2, -2});
    std::array<std::uint64_t, 8> near{};
    for (int i = 0; i < 8; ++i) {
      const auto found = blocks_.find(low + CellKey{i & 1, i >> 1 & 1, i >> 2});
      if (found != blocks_.end()) near[static_cast<std::size_t>(i)] = found->second;
    }
    for (int dz = -2; dz <= 2; ++dz)
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
          const CellKey cell = k + CellKey{dx, dy, dz}, block = block_of(cell);
          const int i = (block.x - low.x) + 2 * (block.y - low.y) + 4 * (block.z - low.z);
          if (near[static_cast<std::size_t>(i)] & bit_of(cell)) visit(dx, dy, dz);
        }
  }

 private:
  static CellKey block_of(const CellKey& k) { return {k.x >> 2, k.y >> 2, k.z >> 2}; }
  static std::uint64_t bit_of(const CellKey& k) {
    return std::uint64_t{1} << ((k.x & 3) | (k.y & 3) << 2 | (k.z & 3) << 4);
  }
  std::unordered_map<CellKey, std::uint64_t, core::CellKeyHash> blocks_;
};

/// Normal of the plane through the cells nearby: the axis along which they spread least.
Vec3 surface_normal(const CellBits& cells, const CellKey& k) {
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double n = 0;
  cells.for_neighbours(k, [&](int dx, int dy, int dz) {
    const Vec3 d(dx, dy, dz);
    sum += d;
    squares += d * d.transpose();
    n += 1;
  });
  const Eigen::Matrix3d covariance = squares / n - (sum / n) * (sum / n).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  return solver.eigenvectors().col(0);
}

}  // namespace

Cloud make_cloud(const std::vector<OccupiedSpan>& growth, double resolution_m, std::size_t max_points,
                 const std::vector<StampedPose>& seen_from, double min_cell_m, std::int32_t flicker_ms) {
  Cloud cloud{resolution_m, merge(growth, flicker_ms), {}};
  while (!cloud.points.empty() && (cloud.points.size() > max_points || cloud.cell_m < 0.999 * min_cell_m)) {
    cloud.points = halved(std::move(cloud.points));
    cloud.cell_m *= 2;
  }
  const CellBits cells(cloud.points);
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
