// The part of the rock surface that a colour camera has imaged.
//
// A surface cell is an occupied cell with a free face neighbour. A camera images it if
// - the face's centre (just outside the cell) is within the camera's range and field of view,
// - the line from the camera to there passes free cells only, and arrives from the face's front,
// - the angle of incidence is at most the camera's greatest. The surface's normal is the
//   mean direction to the free cells among the 5x5x5 around the cell.
// One such face is enough.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/vehicle/rgb_camera_model.h"

namespace karst::core {

struct SurfaceCell {
  CellKey key;
  Vec3 normal = Vec3::Zero();  // unit, into free space; zero if undefined (free on all sides)
};

/// The surface cell of this key; none if the cell is not part of the surface.
std::optional<SurfaceCell> surface_cell(const VoxelMap& map, const CellKey& key);

/// Applies the rules above. `T_world_camera`: x along the optical axis, y left, z up.
bool images(const VoxelMap& map, const Pose& T_world_camera, const RgbCameraModel& camera,
            const SurfaceCell& cell);

/// The cells imaged so far by the core, regardless of later changes of the map.
class ImagedSurface {
 public:
  ImagedSurface() = default;
  explicit ImagedSurface(std::span<const CellKey> cells) : cells_(cells.begin(), cells.end()) {}

  /// Adds the cells imaged by one picture; returns how many are new.
  std::size_t take(const VoxelMap& map, const Pose& T_world_camera, const RgbCameraModel& camera);
  /// Whether the cell or one of its face neighbours was imaged: the map's surface can shift by a cell.
  bool contains(const CellKey& key) const;
  /// All cells, sorted, as a snapshot stores them.
  std::vector<CellKey> cells() const;
  std::size_t size() const { return cells_.size(); }

 private:
  std::unordered_set<CellKey, CellKeyHash> cells_;  // membership only: its order never matters
};

/// The surface cells of a map that are not imaged yet, for many queries on one state of both.
class UnimagedSurface {
 public:
  UnimagedSurface(const VoxelMap& map, const ImagedSurface& imaged);

  const std::vector<SurfaceCell>& cells() const { return cells_; }  // ascending (z, y, x)
  std::size_t surface_cells() const { return surface_cells_; }      // imaged or not
  /// Indices, ascending, of the cells that a picture from this pose would image.
  std::vector<std::uint32_t> seen_from(const Pose& T_world_camera, const RgbCameraModel& camera) const;

 private:
  const VoxelMap* map_;
  std::vector<SurfaceCell> cells_;
  std::size_t surface_cells_ = 0;
  std::unordered_map<CellKey, std::vector<std::uint32_t>, CellKeyHash> blocks_;  // of 8x8x8 cells
};

}  // namespace karst::core
