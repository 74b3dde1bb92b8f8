// Where a vehicle makes room for another, and waits until it is past.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::core {

struct WaitingPlace {
  Vec3 place = Vec3::Zero();
  bool keeps_passage_open = false;
};

struct RoomQuery {
  Vec3 from = Vec3::Zero();
  std::vector<Vec3> flown;     // the path it came along, the oldest point first
  Vec3 other = Vec3::Zero();   // the vehicle that it makes room for
  std::vector<Vec3> moving;    // all further ones that may move
  std::vector<Vec3> standing;  // and those that wait: obstacles in the map
  std::vector<Vec3> failed;    // places where the other did not get by; two are enough
  double separation_m = 1.5;   // the place is so far from all others, or as far as it is now
  double vehicle_radius_m = 0;
};

/// The nearest place that the vehicle comes to before *every* other, not only the one that it makes room for,
/// and where others get by: places connected by the planning clearance still are when those too near to it
/// are taken out. If there is none, as far back along the path flown as it stays ahead of all. Who comes to a
/// place first does not pass another on its way: where it does, that one would be nearer.
std::optional<WaitingPlace> waiting_place(const VoxelMap& map, const Roadmap& roadmap,
                                          const RoomQuery& query);

}  // namespace karst::core
