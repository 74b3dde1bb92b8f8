// The middle lines of the passages that a flight mapped: where they run, meet and end, how wide they are, and
// which of them the vehicle flew. From the slices of the free space (core_stack/planning/passages).
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::survey_export {

/// A place on a middle line. Its cell is free.
struct LinePoint {
  core::Vec3 position = core::Vec3::Zero();
  double width_m = 0, height_m = 0;
  bool flown = false;
  bool detour = false;  // put in so that the line stays in free cells: not in the middle, and not measured
};

/// Where lines meet, or where one ends.
struct LineNode {
  enum class Kind { start, junction, dead_end, open_end };
  Kind kind = Kind::junction;
  LinePoint point;
};

/// From node to node; the outermost points are those of the nodes. Each point sees the next, but for
/// `blocked`.
struct MiddleLine {
  std::array<std::uint32_t, 2> nodes{};  // the first is the nearer one to the start
  std::vector<LinePoint> points;
  std::size_t blocked = 0;  // steps for which no way through free cells was found
};

struct MiddleLines {
  std::vector<LineNode> nodes;    // the first is the start
  std::vector<MiddleLine> lines;  // in the order in which a surveyor reaches them from the start
};

/// The passages connected to `start`, a place where the vehicle stood or flew, by room for a vehicle or by
/// its trajectory `flown`. Empty if the map has no space with room for a vehicle within 5 m of it.
MiddleLines middle_lines(const core::VoxelMap& map, const core::Vec3& start,
                         std::span<const core::Vec3> flown);

}  // namespace karst::survey_export
