#include "core_stack/localization/voxel_grid.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>

namespace karst::core {
namespace {

constexpr int kBits = 21;
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
constexpr std::int32_t kZero = 1 << (kBits - 1);  // stored value of coordinate 0
constexpr std::size_t kFirstSlots = 1 << 12;

std::uint64_t pack(int x, int y, int z) {
  return static_cast<std::uint64_t>(x + kZero) << (2 * kBits) |
         static_cast<std::uint64_t>(y + kZero) << kBits | static_cast<std::uint64_t>(z + kZero);
}

/// Difference between the key of the i-th neighbour and a voxel's key; also the offset in voxels.
struct Neighbour {
  std::uint64_t key_step;
  Vec3 offset;
};
std::array<Neighbour, 27> neighbours() {
  std::array<Neighbour, 27> all;
  for (int i = 0; i < 27; ++i) {
    const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
    all[static_cast<std::size_t>(i)] = {pack(x, y, z) - pack(0, 0, 0), Vec3(x, y, z)};
  }
  return all;
}
const std::array<Neighbour, 27> kNeighbours = neighbours();

}  // namespace

VoxelGrid::VoxelGrid(double voxel_m, std::int64_t max_points)
    : voxel_m_(voxel_m),
      per_m_(static_cast<float>(1 / voxel_m)),
      max_points_(static_cast<float>(max_points)) {
  rebuild(kFirstSlots);
}

VoxelGrid::Key VoxelGrid::key_of(const Vec3f& p) const {
  const auto cell = [this](float v) { return static_cast<int>(std::floor(v * per_m_)); };
  return pack(cell(p.x()), cell(p.y()), cell(p.z()));
}

Vec3 VoxelGrid::centre_of(Key key) const {
  const auto coordinate = [&](int shift) {
    return voxel_m_ * (static_cast<double>(static_cast<std::int32_t>(key >> shift & kMask) - kZero) + 0.5);
  };
  return {coordinate(2 * kBits), coordinate(kBits), coordinate(0)};
}

std::size_t VoxelGrid::home_of(Key key) const {
  const std::uint64_t hash = (key >> 2) * 0x9e3779b97f4a7c15ull;
  return ((hash >> 32 << 2) | (key & 3)) & (table_.size() - 1);
}

std::size_t VoxelGrid::slot_of(Key key) const {
  std::size_t slot = home_of(key);
  while (table_[slot].voxel != 0 && table_[slot].key != key) slot = (slot + 1) & (table_.size() - 1);
  return slot;
}

void VoxelGrid::rebuild(std::size_t slots) {
  table_.assign(slots, {0, 0});
  for (std::size_t i = 0; i < voxels_.size(); ++i)
    table_[slot_of(voxels_[i].key)] = {voxels_[i].key, static_cast<std::uint32_t>(i + 1)};
}

VoxelSums& VoxelGrid::made(Key key) {
  std::size_t slot = slot_of(key);
  if (table_[slot].voxel == 0) {
    if (2 * (voxels_.size() + 1) > table_.size()) {
      rebuild(2 * table_.size());
      slot = slot_of(key);
    }
    voxels_.push_back({key, {}});
    table_[slot] = {key, static_cast<std::uint32_t>(voxels_.size())};
  }
  return voxels_[table_[slot].voxel - 1].sums;
}

void VoxelGrid::insert(std::span<const Vec3f> points) {
  Key last_key = ~Key{0};
  VoxelSums* v = nullptr;
  Vec3f centre = Vec3f::Zero();
  for (const Vec3f& p : points) {
    const Key key = key_of(p);
    if (key != last_key) {  // consecutive points of a ring mostly share a voxel
      v = &made(key);
      last_key = key;
      centre = centre_of(key).cast<float>();
    }
    if (v->points >= max_points_) continue;
    const Vec3f d = p - centre;
    v->points += 1;
    v->sum += d;
    v->products[0] += d.x() * d.x();
    v->products[1] += d.x() * d.y();
    v->products[2] += d.x() * d.z();
    v->products[3] += d.y() * d.y();
    v->products[4] += d.y() * d.z();
    v->products[5] += d.z() * d.z();
  }
}

void VoxelGrid::merge(const VoxelGrid& other) {
  for (const Voxel& from : other.voxels_) {
    const Vec3 centre = other.centre_of(from.key);
    const Key key = key_of(centre.cast<float>());
    VoxelSums& to = made(key);
    if (to.points >= max_points_) continue;
    // Points d about their voxel's centre are d + o about the centre of this voxel; see surface_of.
    const Vec3f o = (centre - centre_of(key)).cast<float>();
    const VoxelSums& v = from.sums;
    const Vec3f shifted = v.sum + v.points * o;
    to.points += v.points;
    to.sum += shifted;
    std::size_t i = 0;
    for (int r = 0; r < 3; ++r)
      for (int c = r; c < 3; ++c, ++i) to.products[i] += v.products[i] + v.sum[r] * o[c] + o[r] * shifted[c];
  }
}

void VoxelGrid::clear() {
  voxels_.clear();
  std::fill(table_.begin(), table_.end(), Slot{0, 0});
}

/// Moves the last voxel into the erased voxel's index. In the table, moves later entries into the hole where
/// allowed, so that every search still ends at the first free slot.
void VoxelGrid::erase(std::size_t voxel) {
  const std::size_t mask = table_.size() - 1;
  std::size_t hole = slot_of(voxels_[voxel].key);
  if (voxel + 1 < voxels_.size()) {
    table_[slot_of(voxels_.back().key)].voxel = static_cast<std::uint32_t>(voxel + 1);
    voxels_[voxel] = voxels_.back();
  }
  voxels_.pop_back();
  for (std::size_t slot = (hole + 1) & mask; table_[slot].voxel != 0; slot = (slot + 1) & mask) {
    const std::size_t from_home = (slot - home_of(table_[slot].key)) & mask;
    if (from_home < ((slot - hole) & mask)) continue;  // it would move to before its home slot
    table_[hole] = table_[slot];
    hole = slot;
  }
  table_[hole].voxel = 0;
}

void VoxelGrid::forget_some(const Vec3& centre, double radius_m, std::size_t count) {
  for (std::size_t i = 0; i < count && !voxels_.empty(); ++i) {
    if (turn_ >= voxels_.size()) turn_ = 0;
    if ((centre_of(voxels_[turn_].key) - centre).cwiseAbs().maxCoeff() > radius_m)
      erase(turn_);
    else
      ++turn_;
  }
}

void VoxelGrid::keep_nearest(const Vec3& centre, std::size_t max_voxels) {
  if (voxels_.size() <= max_voxels) return;
  const auto distance = [&](const Voxel& v) { return (centre_of(v.key) - centre).cwiseAbs().maxCoeff(); };
  std::vector<double> distances;
  for (const Voxel& v : voxels_) distances.push_back(distance(v));
  const auto first_dropped = distances.begin() + static_cast<std::ptrdiff_t>(max_voxels);
  std::nth_element(distances.begin(), first_dropped, distances.end());
  std::erase_if(voxels_, [&](const Voxel& v) { return distance(v) >= *first_dropped; });
  rebuild(table_.size());
}

const VoxelGrid::Voxel* VoxelGrid::find(Key key) const {
  const std::uint32_t i = table_[slot_of(key)].voxel;
  return i == 0 ? nullptr : &voxels_[i - 1];
}

VoxelGrid::Window VoxelGrid::window_around(Key key) const {
  // A large table does not fit the cache: prefetching the slots overlaps their latencies.
  for (std::size_t i = 0; i < 9; ++i) __builtin_prefetch(&table_[home_of(key + kNeighbours[i].key_step)]);
  Window window;
  for (std::size_t i = 0; i < 27; ++i) {
    const Voxel* v = find(key + kNeighbours[i].key_step);
    window[i] = v ? &v->sums : nullptr;
    __builtin_prefetch(window[i]);
  }
  return window;
}

std::size_t VoxelGrid::bytes() const {
  return voxels_.capacity() * sizeof(Voxel) + table_.capacity() * sizeof(Slot);
}

Surface surface_of(const VoxelGrid& grid, VoxelGrid::Key centre, const VoxelGrid::Window& window,
                   double least) {
  Surface s;
  for (const VoxelSums* v : window)
    if (v) s.points += v->points;
  if (s.points < least) return s;
  // Sums about the centre of the window, from those of a voxel with offset o:
  //   sum (d + o) = sum d + n o,   sum (d + o)(d + o)' = sum dd' + (sum d) o' + o (sum d)' + n o o'
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 27; ++i) {
    const VoxelSums* v = window[i];
    if (!v) continue;
    const Vec3 o = grid.voxel_m() * kNeighbours[i].offset, d = v->sum.cast<double>();
    const Vec3 shifted = d + static_cast<double>(v->points) * o;
    sum += shifted;
    const auto& q = v->products;
    Eigen::Matrix3d own;
    own << q[0], q[1], q[2], q[1], q[3], q[4], q[2], q[4], q[5];
    products += own + d * o.transpose() + o * shifted.transpose();
  }
  const Vec3 mean = sum / s.points;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(products / s.points - mean * mean.transpose());
  s.mean = grid.centre_of(centre) + mean;
  s.axes = solver.eigenvectors();
  s.deviation_m = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  return s;
}

MeanPair means_of(const VoxelGrid& grid, VoxelGrid::Key centre, const VoxelGrid::Window& a,
                  const VoxelGrid::Window& b) {
  MeanPair pair;
  for (std::size_t i = 0; i < 27; ++i) {
    if (!a[i] || !b[i]) continue;
    const double points = std::min(a[i]->points, b[i]->points);
    const Vec3 o = grid.voxel_m() * kNeighbours[i].offset;
    pair.points += points;
    pair.a += points * (o + (a[i]->sum / a[i]->points).cast<double>());
    pair.b += points * (o + (b[i]->sum / b[i]->points).cast<double>());
  }
  if (pair.points == 0) return pair;
  const Vec3 middle = grid.centre_of(centre);
  pair.a = middle + pair.a / pair.points;
  pair.b = middle + pair.b / pair.points;
  return pair;
}

}  // namespace karst::core
