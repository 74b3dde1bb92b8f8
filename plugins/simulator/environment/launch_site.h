// Where the vehicle stands before take-off.
#pragma once
#include "plugins/simulator/cave/cave.h"

namespace karst::sim {

struct LaunchSite {
  core::Pose T_world_start;  // standing
  bool pad = false;          // it stands on a launch pad and not on the floor
};

/// Lowers the vehicle's sphere from the cave's start pose until it touches. If what it touches first is too
/// steep to stand on, or more than 3 m below, it stands on a pad at the start pose instead: a level disc of
/// 0.5 m radius which then belongs to the cave's mesh, to be seen and to be landed on as any rock.
LaunchSite set_down(cave::Cave& cave, double radius_m);

}  // namespace karst::sim
