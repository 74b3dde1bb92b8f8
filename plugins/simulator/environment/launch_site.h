// The site where the vehicle stands before take-off.
#pragma once
#include "plugins/simulator/cave/cave.h"

namespace karst::sim {

struct LaunchSite {
  core::Pose T_world_start;  // standing
  bool pad = false;          // it stands on a launch pad and not on the floor
};

/// Lowers the vehicle's sphere from the cave's start pose until it touches rock. If that rock is too steep to
/// stand on, or more than 3 m below, the vehicle stands on a pad at the start pose instead: a level disc of
/// 0.5 m radius that becomes part of the cave's mesh, which sensors see and vehicles can land on.
LaunchSite set_down(cave::Cave& cave, double radius_m);

}  // namespace karst::sim
