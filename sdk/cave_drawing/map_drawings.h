// The three drawings of a map, with what is known of the flight that made it.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/mapping/region/flight_region.h"
#include "sdk/cave_drawing/drawing.h"

namespace karst::cave_drawing {

struct Find {
  std::string what;
  core::Vec3 position = core::Vec3::Zero();
};

struct FlightRecord {
  std::string name, date, from = "map";
  std::optional<core::Vec3> entrance;  // where heights are zero
  std::vector<core::Vec3> path;
  std::vector<Find> finds;
  std::shared_ptr<const core::FlightRegion> region;  // of the mission; null: none
};

/// Without an entrance, heights are those of the map, and the extended profile begins in its roomiest place.
/// Without a bearing, the projected profile shows the greatest extent. Throws core::InputError that names
/// `file` if the map has no free cell, or a position or the bearing is not finite.
CaveDrawings map_drawings(const core::VoxelMap& map, const FlightRecord& record,
                          std::optional<double> bearing_rad, const std::string& file);

}  // namespace karst::cave_drawing
