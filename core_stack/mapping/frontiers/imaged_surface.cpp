#include "core_stack/mapping/frontiers/imaged_surface.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core_stack/mapping/occupancy/cell_walk.h"
#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::core {
namespace {

constexpr double kOutside = 0.55;  // cell edges from a cell's centre to just outside its face

CellKey bin_of(const CellKey& k) { return {k.x >> 3, k.y >> 3, k.z >> 3}; }

bool is_surface(VoxelReader& cells, const CellKey& k) {
  return cells.at(k) == Cell::occupied && std::any_of(kFaces.begin(), kFaces.end(), [&](const CellKey& face) {
           return cells.at(k + face) == Cell::free;
         });
}

Vec3 normal_at(VoxelReader& cells, const CellKey& k) {
  Vec3 sum = Vec3::Zero();
  for (std::int32_t z = -2; z <= 2; ++z)
    for (std::int32_t y = -2; y <= 2; ++y)
      for (std::int32_t x = -2; x <= 2; ++x)
        if (cells.at(k + CellKey{x, y, z}) == Cell::free) sum += Vec3(x, y, z).normalized();
  const double length = sum.norm();
  return length < 1e-9 ? Vec3(0, 0, 0) : Vec3(sum / length);
}

/// A camera at the pose of a picture, and a test of what it sees of single cells. Lengths in cells.
class View {
 public:
  View(const VoxelMap& map, const Pose& T_world_camera, const RgbCameraModel& model)
      : cells_(map),
        resolution_m_(map.resolution_m()),
        eye_(T_world_camera.position / resolution_m_),
        to_camera_(T_world_camera.orientation.conjugate().toRotationMatrix()),
        half_width_(std::tan(model.camera.horizontal_fov_rad / 2)),
        half_height_(std::tan(model.camera.vertical_fov_rad / 2)),
        nearest_(static_cast<double>(model.camera.min_range_m) / resolution_m_),
        furthest_(static_cast<double>(model.camera.max_range_m) / resolution_m_),
        min_facing_(std::cos(model.max_incidence_rad)) {}

  VoxelReader& cells() { return cells_; }

  /// A quick test before a cell's normal is computed: can any of its faces be in the picture?
  bool may_see(const CellKey& k) const {
    const Vec3 p = to_camera_ * (center(k) - eye_);
    const double radius = furthest_ + 1, margin = 1 + half_width_ + half_height_;
    return p.squaredNorm() <= radius * radius && p.x() > -1 &&
           std::abs(p.y()) <= p.x() * half_width_ + margin &&
           std::abs(p.z()) <= p.x() * half_height_ + margin;
  }

  bool sees(const SurfaceCell& cell) {
    const Vec3 back = eye_ - center(cell.key);
    const bool slanted = cell.normal.squaredNorm() > 0 && cell.normal.dot(back) < min_facing_ * back.norm();
    if (slanted) return false;
    for (const CellKey& face : kFaces) {
      const Vec3 out(face.x, face.y, face.z);
      const Vec3 place = center(cell.key) + kOutside * out;
      if (out.dot(eye_ - place) <= 0 || !in_picture(place)) continue;
      if (cells_.at(cell.key + face) == Cell::free && clear_to(place)) return true;
    }
    return false;
  }

 private:
  static Vec3 center(const CellKey& k) { return {k.x + 0.5, k.y + 0.5, k.z + 0.5}; }
  bool in_picture(const Vec3& place) const {
    const Vec3 p = to_camera_ * (place - eye_);
    const double range = p.norm();
    return range >= nearest_ && range <= furthest_ && p.x() > 0 && std::abs(p.y()) <= p.x() * half_width_ &&
           std::abs(p.z()) <= p.x() * half_height_;
  }
  bool clear_to(const Vec3& place) {
    bool clear = true;
    walk_cells(eye_, place, [&](PackedCell c) { return clear = cells_.at(unpack(c)) == Cell::free; });
    return clear;
  }

  VoxelReader cells_;
  double resolution_m_;
  Vec3 eye_;
  Eigen::Matrix3d to_camera_;
  double half_width_, half_height_, nearest_, furthest_, min_facing_;
};

bool usable(const VoxelMap& map, const Pose& T_world_camera) {
  constexpr double kWorld_cells = 40000;  // the map ends nearer than this
  return T_world_camera.position.allFinite() && T_world_camera.orientation.coeffs().allFinite() &&
         (T_world_camera.position / map.resolution_m()).cwiseAbs().maxCoeff() < kWorld_cells;
}

/// Corners of the box around all cells that a camera at this pose could see.
std::array<CellKey, 2> box_around(const VoxelMap& map, const Pose& T_world_camera,
                                  const RgbCameraModel& model) {
  const Vec3 radius = Vec3::Constant(static_cast<double>(model.camera.max_range_m) + map.resolution_m());
  return {map.key_of(T_world_camera.position - radius), map.key_of(T_world_camera.position + radius)};
}

}  // namespace

std::optional<SurfaceCell> surface_cell(const VoxelMap& map, const CellKey& key) {
  VoxelReader cells(map);
  if (!is_surface(cells, key)) return std::nullopt;
  return SurfaceCell{key, normal_at(cells, key)};
}

bool images(const VoxelMap& map, const Pose& T_world_camera, const RgbCameraModel& camera,
            const SurfaceCell& cell) {
  return usable(map, T_world_camera) && View(map, T_world_camera, camera).sees(cell);
}

std::size_t ImagedSurface::take(const VoxelMap& map, const Pose& T_world_camera,
                                const RgbCameraModel& camera) {
  if (!usable(map, T_world_camera)) return 0;
  const std::size_t before = cells_.size();
  View view(map, T_world_camera, camera);
  const auto [low, high] = box_around(map, T_world_camera, camera);
  map.for_each_in_box(low, high, [&](const CellKey& k, Cell c) {
    if (c != Cell::occupied || !view.may_see(k) || cells_.count(k) || !is_surface(view.cells(), k)) return;
    if (view.sees({k, normal_at(view.cells(), k)})) cells_.insert(k);
  });
  return cells_.size() - before;
}

bool ImagedSurface::contains(const CellKey& key) const {
  return cells_.count(key) || std::any_of(kFaces.begin(), kFaces.end(),
                                          [&](const CellKey& face) { return cells_.count(key + face) > 0; });
}

std::vector<CellKey> ImagedSurface::cells() const {
  std::vector<CellKey> all(cells_.begin(), cells_.end());
  std::sort(all.begin(), all.end());
  return all;
}

UnimagedSurface::UnimagedSurface(const VoxelMap& map, const ImagedSurface& imaged) : map_(&map) {
  VoxelReader cells(map);
  map.for_each_known([&](const CellKey& k, Cell c, float) {
    if (c != Cell::occupied || !is_surface(cells, k)) return;
    ++surface_cells_;
    if (!imaged.contains(k)) cells_.push_back({k, normal_at(cells, k)});
  });
  std::sort(cells_.begin(), cells_.end(), [](const SurfaceCell& a, const SurfaceCell& b) {
    return std::tie(a.key.z, a.key.y, a.key.x) < std::tie(b.key.z, b.key.y, b.key.x);
  });
  for (std::size_t i = 0; i < cells_.size(); ++i)
    blocks_[bin_of(cells_[i].key)].push_back(static_cast<std::uint32_t>(i));
}

std::vector<std::uint32_t> UnimagedSurface::seen_from(const Pose& T_world_camera,
                                                      const RgbCameraModel& camera) const {
  std::vector<std::uint32_t> seen;
  if (!usable(*map_, T_world_camera)) return seen;
  View view(*map_, T_world_camera, camera);
  const auto [first, last] = box_around(*map_, T_world_camera, camera);
  const CellKey low = bin_of(first), high = bin_of(last);
  for (CellKey b = low; b.z <= high.z; ++b.z)
    for (b.y = low.y; b.y <= high.y; ++b.y)
      for (b.x = low.x; b.x <= high.x; ++b.x)
        if (const auto found = blocks_.find(b); found != blocks_.end())
          for (const std::uint32_t i : found->second)
            if (view.may_see(cells_[i].key) && view.sees(cells_[i])) seen.push_back(i);
  std::sort(seen.begin(), seen.end());
  return seen;
}

}  // namespace karst::core
