// Which of two vehicles gives way.
#pragma once
#include <vector>

#include "core_stack/homing/messages.h"

namespace karst::core {

/// Another vehicle in the air, as last heard and brought up to now.
struct Neighbour {
  RobotId robot = 0;
  Vec3 position = Vec3::Zero(), velocity_mps = Vec3::Zero();
  bool committed = false;  // it takes off or lands: it cannot stop for anybody
};

struct KeepApart {
  double distance_m = 3.0;
  double reaction_s = 1.5;  // news are up to a second old, and a brake takes its time to begin
  double brake_mps2 = 1.0;
};

/// The distance below which one of the two has to stop: what is kept, and what both need to stop if they
/// approach.
double least_distance_m(const KeepApart& rule, const Vec3& position, const Vec3& velocity_mps,
                        const Neighbour& other);

/// The others that vehicle `self` has to stop for: those too near that it gives way to. Of two robots the
/// higher number gives way, but to one that takes off or lands everybody does. Nearer than half of the
/// distance and approaching both stop.
std::vector<Neighbour> give_way_to(const KeepApart& rule, RobotId self, const Vec3& position,
                                   const Vec3& velocity_mps, const std::vector<Neighbour>& others);

}  // namespace karst::core
