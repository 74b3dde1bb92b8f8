// The middle of a cave's passages as a graph of places: what an extended profile is unrolled along.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::cave_drawing {

struct PassagePoint {
  core::Vec3 middle = core::Vec3::Zero();
  double width_m = 0, height_m = 0;
  std::vector<std::uint32_t> next;  // places beside it, sorted
  bool leads_on = false;            // an end without a wall: unknown space lies behind it
};

struct PassageLines {
  std::vector<PassagePoint> points;
  std::uint32_t first = 0;  // the one at the start
  double length_m() const;  // of all lines between places
};

/// The passages connected to the start (core_stack/planning/passages, of which this keeps the middle line).
/// `flown` connects passages as well: a vehicle came through there. Without points if there is no room for a
/// vehicle within 5 m of the start. Throws core::InputError that names `file` if the map is too large for it.
PassageLines passage_lines(const core::VoxelMap& map, const core::Vec3& start, const std::string& file,
                           std::span<const core::Vec3> flown = {});

}  // namespace karst::cave_drawing
