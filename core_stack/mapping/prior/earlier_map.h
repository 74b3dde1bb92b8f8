// The map of an earlier flight: the search for what is seen now in it, and its cells in the frame of now.
// docs/earlier_map.md
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/mapping/registration/map_registration.h"

namespace karst::core {

/// In its own frame, z up.
struct EarlierMap {
  std::string name;  // its file, for messages
  MapPiece piece;    // with cells
  MapPiece surface;  // the same on the rock's surface (rock_surface.h)
};

/// Throws std::invalid_argument if the map has no occupied or no free cell.
std::shared_ptr<const EarlierMap> earlier_map_of(std::string name, std::shared_ptr<const VoxelMap> cells);

/// The known cells of `map` within the box of +-reach_m around a place, as classes: what is seen from there.
std::shared_ptr<const VoxelMap> surroundings(const VoxelMap& map, const Vec3& place, double reach_m);

/// The limits for what is seen around one place, which mostly lies within the earlier map.
MapRegistrationOptions localization_limits();

/// Where what is seen lies in the earlier map: T_target_source is T_earlier_world. Not trusted, with the
/// reason, if nothing fits, if something contradicts, or if two places fit. Deterministic.
MapRegistration locate_in(const EarlierMap& earlier, std::shared_ptr<const VoxelMap> seen,
                          const MapRegistrationOptions& options = localization_limits());

/// The earlier map's cells in another frame, in the order of their keys: a cell is occupied if its centre
/// lies in an occupied cell, or the centre of an occupied one in it; else free if its centre lies in a free
/// one.
///
/// The values are those of very few scans, so that what is seen now wins: of two misses for free cells, which
/// one hit outweighs, and of one hit for occupied ones.
std::vector<CellValue> moved_cells(const EarlierMap& earlier, const Pose& T_world_earlier,
                                   const MapOptions& options);

}  // namespace karst::core
