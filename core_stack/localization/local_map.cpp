#include "core_stack/localization/local_map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace karst::core {
void describe(OptionTable& t, LocalMapOptions& o) {
  t.add("voxel", o.voxel_m, "m", 0.05, 5, "edge of a voxel; surfaces are fitted to windows of three");
  t.add("coarse_voxel", o.coarse_voxel_m, "m", 0.1, 20, "edge of a voxel of the level for sparse points");
  t.add("radius", o.radius_m, "m", 5, 500, "rock farther away along any axis is forgotten");
  t.add("max_blocks", o.max_blocks, 100, 10'000'000, "blocks of 4x4x4 voxels kept at most, a level");
  t.add("max_points", o.max_points, 10, 100'000, "points added to a voxel at most");
}

VoxelLevel::VoxelLevel(double voxel_m, std::int64_t max_points)
    : voxel_m_(voxel_m), max_points_(static_cast<float>(max_points)) {}

std::uint64_t VoxelLevel::key_of(const Eigen::Vector3i& block) {
  const auto bits = [](int v) { return static_cast<std::uint64_t>(v + (1 << 20)) & 0x1fffff; };
  return bits(block.x()) << 42 | bits(block.y()) << 21 | bits(block.z());
}

const VoxelLevel::Block* VoxelLevel::find(const Eigen::Vector3i& block) const {
  const auto at = index_.find(key_of(block));
  return at == index_.end() ? nullptr : &blocks_[at->second];
}

void VoxelLevel::insert(std::span<const Vec3f> points_world) {
  std::uint64_t last_key = ~std::uint64_t{0};
  std::uint32_t last_block = 0;
  const auto edge = static_cast<float>(voxel_m_);
  for (const Vec3f& p : points_world) {
    const Eigen::Vector3i voxel = (p / edge).array().floor().cast<int>();
    const Eigen::Vector3i block = voxel.unaryExpr([](int v) { return v >> 2; });
    const std::uint64_t key = key_of(block);
    if (key != last_key) {
      const auto [at, made] = index_.try_emplace(key, static_cast<std::uint32_t>(blocks_.size()));
      if (made) blocks_.push_back({block * kEdge, {}});
      last_key = key, last_block = at->second;
    }
    const Eigen::Vector3i in = voxel - blocks_[last_block].corner;
    VoxelSums& v =
        blocks_[last_block].voxels[static_cast<std::size_t>(in.x() + kEdge * (in.y() + kEdge * in.z()))];
    if (v.points >= max_points_) continue;
    const Vec3f d = p - edge * (voxel.cast<float>().array() + 0.5f).matrix();
    v.points += 1;
    v.sum += d;
    v.products[0] += d.x() * d.x(), v.products[1] += d.x() * d.y(), v.products[2] += d.x() * d.z();
    v.products[3] += d.y() * d.y(), v.products[4] += d.y() * d.z(), v.products[5] += d.z() * d.z();
  }
}

Surface VoxelLevel::surface_near(const Vec3& p, double least) const {
  const Eigen::Vector3i centre = voxel_of(p);
  const Eigen::Vector3i low = centre.array() - 1, high = centre.array() + 1;
  // Sums over the window, about the middle of the centre voxel.
  double n = 0;
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  const auto add = [&](const VoxelSums& v, const Eigen::Vector3i& voxel) {
    if (v.points == 0) return;
    const Vec3 shift = voxel_m_ * (voxel - centre).cast<double>();
    const Vec3 s = v.sum.cast<double>();
    const double m = v.points;
    n += m;
    sum += s + m * shift;
    Eigen::Matrix3d q;
    q << v.products[0], v.products[1], v.products[2], v.products[1], v.products[3], v.products[4],
        v.products[2], v.products[4], v.products[5];
    products += q + s * shift.transpose() + shift * s.transpose() + m * shift * shift.transpose();
  };
  Eigen::Vector3i b;
  for (b.z() = low.z() >> 2; b.z() <= high.z() >> 2; ++b.z())
    for (b.y() = low.y() >> 2; b.y() <= high.y() >> 2; ++b.y())
      for (b.x() = low.x() >> 2; b.x() <= high.x() >> 2; ++b.x()) {
        const Block* block = find(b);
        if (!block) continue;
        const Eigen::Vector3i from = low.cwiseMax(block->corner);
        const Eigen::Vector3i to = high.cwiseMin((block->corner.array() + kEdge - 1).matrix());
        Eigen::Vector3i v;
        for (v.z() = from.z(); v.z() <= to.z(); ++v.z())
          for (v.y() = from.y(); v.y() <= to.y(); ++v.y())
            for (v.x() = from.x(); v.x() <= to.x(); ++v.x()) {
              const Eigen::Vector3i in = v - block->corner;
              add(block->voxels[static_cast<std::size_t>(in.x() + kEdge * (in.y() + kEdge * in.z()))], v);
            }
      }
  Surface s;
  s.points = n;
  if (n < least) return s;
  const Vec3 mean = sum / n;
  const Eigen::Matrix3d scatter = products / n - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scatter);
  s.mean = mean + voxel_m_ * (centre.cast<double>().array() + 0.5).matrix();
  s.axes = solver.eigenvectors();
  s.deviation_m = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  return s;
}

void VoxelLevel::drop(std::size_t i) {
  index_.erase(key_of(blocks_[i].corner / kEdge));
  if (i + 1 < blocks_.size()) {
    blocks_[i] = blocks_.back();
    index_[key_of(blocks_[i].corner / kEdge)] = static_cast<std::uint32_t>(i);
  }
  blocks_.pop_back();
}

void VoxelLevel::roll(const Vec3& centre, double radius_m, std::size_t max_blocks) {
  const auto distance = [&](const Block& b) {
    const Vec3 middle = voxel_m_ * (b.corner.cast<double>().array() + kEdge / 2.0).matrix();
    return (middle - centre).cwiseAbs().maxCoeff();
  };
  if (blocks_.size() > max_blocks) {
    std::vector<double> distances;
    for (const Block& b : blocks_) distances.push_back(distance(b));
    const auto last_kept = distances.begin() + static_cast<std::ptrdiff_t>(max_blocks);
    std::nth_element(distances.begin(), last_kept, distances.end());
    radius_m = std::min(radius_m, std::nextafter(*last_kept, 0.0));  // of those as far as that none is kept
  }
  for (std::size_t i = 0; i < blocks_.size();)
    if (distance(blocks_[i]) > radius_m)
      drop(i);
    else
      ++i;
}

std::size_t VoxelLevel::voxels() const {
  std::size_t n = 0;
  for (const Block& b : blocks_)
    n += static_cast<std::size_t>(
        std::count_if(b.voxels.begin(), b.voxels.end(), [](const VoxelSums& v) { return v.points > 0; }));
  return n;
}

std::size_t VoxelLevel::bytes() const {
  return blocks_.capacity() * sizeof(Block) + index_.size() * 32 + index_.bucket_count() * sizeof(void*);
}

}  // namespace karst::core
