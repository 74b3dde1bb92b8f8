// Guides motion with a receding horizon: keeps the distances to the goal, and plans the next seconds in the
// map.
//
// It runs on the map lane.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mission/world_model/world_model.h"
#include "core_stack/planning/horizon/horizon_planner.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

class HorizonGuide {
 public:
  explicit HorizonGuide(const VehicleDescription& vehicle);
  /// The next seconds of motion (plan_horizon). What is seen is worth the more the less a second of the
  /// exploration so far, which took `exploring_s`, has seen; nothing if that is not given. Nothing if the
  /// goal has no clear way to it, or if what is under way is as good.
  std::optional<HorizonPlan> plan(WorldModel& world, HorizonQuery query, std::optional<double> exploring_s);

 private:
  std::vector<ViewRay> rays_;
  double steepest_rad_;
  DistanceTree to_goal_;
};

}  // namespace karst::core
