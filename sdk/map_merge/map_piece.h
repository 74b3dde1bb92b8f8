// One flight's map, as registration looks at it.
#pragma once
#include <memory>
#include <vector>

#include "core_stack/mapping/obstacles/point_tree.h"
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::map_merge {

/// Rock surface as points, z up; of an occupancy map also the space known to be free, which no other map's
/// rock may stand in.
struct MapPiece {
  std::shared_ptr<const core::VoxelMap> cells;  // null: a bare cloud
  double resolution_m = 0.2;                    // of the cells, or to which a cloud was thinned out
  std::vector<core::Vec3f> surface;             // centres of occupied cells, or points; sorted
  std::vector<core::Vec3f> normals;  // unit; towards free space where that is known, else up to sign
  std::shared_ptr<const core::PointTree> tree;  // over `surface`

  bool knows_free_space() const { return cells != nullptr; }
};

/// Throws std::invalid_argument if the map has no occupied cell.
MapPiece piece_of(std::shared_ptr<const core::VoxelMap> map);
/// Points that are not finite are left out; the others are thinned out to one a cell of `resolution_m`, their
/// mean. Throws std::invalid_argument if none is left.
MapPiece piece_of(const std::vector<core::Vec3f>& cloud, double resolution_m);

/// One point, the mean, for each cell that holds any; in the order of the cells.
std::vector<core::Vec3f> thinned_out(const std::vector<core::Vec3f>& points, double cell_m);

}  // namespace karst::map_merge
