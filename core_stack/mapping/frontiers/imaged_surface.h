// The part of the rock surface that a colour camera has imaged.
//
// A surface cell is an occupied cell with a free face neighbour. A camera images it if
// - the face's centre (just outside the cell) is within the camera's range and field of view,
// - the way from the camera to there leads through free cells only, and comes from the face's front,
// - the surface is not seen more at a slant than the camera's greatest incidence. The surface's normal is the
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
  Vec3 normal = Vec3::Zero();  // unit, into free space; zero where it has no direction: free on all sides
};

/// The cell as part of the surface; nothing if it is not.
std::optional<SurfaceCell> surface_cell(const VoxelMap& map, const CellKey& key);

/// By the rules above. `T_world_camera`: x along the optical axis, y left, z up.
bool images(const VoxelMap& map, const Pose& T_world_camera, const RgbCameraModel& camera,
            const SurfaceCell& cell);

/// The core's account: the cells imaged so far, whatever the map has made of them since.
class ImagedSurface {
 public:
  ImagedSurface() = default;
  explicit ImagedSurface(std::span<const CellKey> cells) : cells_(cells.begin(), cells.end()) {}

  /// Takes in one picture; returns how many cells it added.
  std::size_t take(const VoxelMap& map, const Pose& T_world_camera, const RgbCameraModel& camera);
  /// It, or a cell that shares a face with it, was imaged: the map's surface shifts by a cell now and then.
  bool contains(const CellKey& key) const;
  /// All cells, sorted: the flat form in which a snapshot carries them.
  std::vector<CellKey> cells() const;
  std::size_t size() const { return cells_.size(); }

 private:
  std::unordered_set<CellKey, CellKeyHash> cells_;  // membership only: its order decides nothing
};

/// The surface cells of a map that are not imaged yet, for many questions about one state of both.
class UnimagedSurface {
 public:
  UnimagedSurface(const VoxelMap& map, const ImagedSurface& imaged);

  const std::vector<SurfaceCell>& cells() const { return cells_; }  // ascending (z, y, x)
  std::size_t surface_cells() const { return surface_cells_; }      // imaged or not
  /// Indices, ascending, of the cells that a picture from there would image.
  std::vector<std::uint32_t> seen_from(const Pose& T_world_camera, const RgbCameraModel& camera) const;

 private:
  const VoxelMap* map_;
  std::vector<SurfaceCell> cells_;
  std::size_t surface_cells_ = 0;
  std::unordered_map<CellKey, std::vector<std::uint32_t>, CellKeyHash> blocks_;  // of 8x8x8 cells
};

}  // namespace karst::core
