// One flight's map in the form used for registration.
#pragma once
#include <memory>
#include <vector>

#include "core_stack/mapping/obstacles/point_tree.h"
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// Rock surface as points, z up; for an occupancy map also its known free space, in which the other map must
/// have no rock.
struct MapPiece {
  std::shared_ptr<const VoxelMap> cells;  // null for a point cloud
  double resolution_m = 0.2;              // of the cells, or to which a cloud was thinned
  std::vector<Vec3f> surface;             // centres of occupied cells, or points; sorted
  std::vector<Vec3f> normals;             // unit; towards free space if known, else with unknown sign
  std::shared_ptr<const PointTree> tree;  // over `surface`

  bool knows_free_space() const { return cells != nullptr; }
};

/// Throws std::invalid_argument if the map has no occupied cell.
MapPiece piece_of(std::shared_ptr<const VoxelMap> map);
/// Leaves out points that are not finite and thins the others to one per cell of `resolution_m`, their mean.
/// Throws std::invalid_argument if none is left.
MapPiece piece_of(const std::vector<Vec3f>& cloud, double resolution_m);

}  // namespace karst::core
