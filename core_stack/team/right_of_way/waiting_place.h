// Finds the place where a vehicle waits until another has passed.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/roadmap/roadmap.h"
#include "core_stack/team/right_of_way/separation.h"

namespace karst::core {

struct WaitingPlace {
  Vec3 place = Vec3::Zero();
  bool keeps_passage_open = false;
};

struct RoomQuery {
  Vec3 from = Vec3::Zero();
  std::vector<Vec3> flown;        // its flown path, oldest point first
  std::vector<Neighbour> others;  // the vehicle to make room for, and all others; those aside do not move
  std::vector<Vec3> failed;       // where it waited long enough, or the other could not pass; two suffice
  double separation_m = 1.5;      // from all others, or the present distance if that is less
  double vehicle_radius_m = 0;
};

/// The nearest place that the vehicle reaches before *every* other vehicle, not only the one that it makes
/// room for, and that keeps the passage open: connectivity at the planning clearance is preserved when the
/// cells too near to the place are removed. If there is none, the farthest place back along the flown path at
/// which the vehicle still arrives first. It arrives first by a metre, or by 0.4 of the present distance if
/// that is less. By the triangle inequality it then keeps as far from the other all the way, as long as the
/// other is no faster.
std::optional<WaitingPlace> waiting_place(const VoxelMap& map, const Roadmap& roadmap,
                                          const RoomQuery& query);

}  // namespace karst::core
