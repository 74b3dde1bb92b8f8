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
  /// The next seconds of motion (plan_horizon). A cubic metre is worth twice the time that one has taken so
  /// far, `exploring_s` by the known free volume. Without `exploring_s` nothing is worth a detour. Returns
  /// nothing if no clear way leads to the goal, or if what is under way is as good.
  std::optional<HorizonPlan> plan(WorldModel& world, HorizonQuery query, std::optional<double> exploring_s);

 private:
  std::vector<ViewRay> rays_;
  double steepest_rad_;
  DistanceTree to_goal_;
};

}  // namespace karst::core
