#include "core_stack/mission/decision/horizon_guide.h"

#include <algorithm>

#include "core_stack/mission/decision/visibility.h"

namespace karst::core {
namespace {

/// In the first seconds what is seen from the start says little of the cave.
constexpr double kShortest_s = 10;
constexpr double kLeast_m3 = 1;
/// What is passed unseen costs the way back to it as well, and not only the time that a volume takes on
/// average.
constexpr double kWorth = 2;

}  // namespace

HorizonGuide::HorizonGuide(const VehicleDescription& vehicle) : rays_(view_rays(vehicle)) {
  const SteepestView view = steepest_view(vehicle);
  steepest_rad_ = std::min(1.5, std::min(view.up_rad, view.down_rad));
}

std::optional<HorizonPlan> HorizonGuide::plan(WorldModel& world, HorizonQuery query,
                                              std::optional<double> exploring_s) {
  const VoxelMap& map = world.map();
  const ClearanceRoadmap& usual = world.usual();
  const auto root =
      usual.roadmap().approach(map, query.goal.position, usual.planning().preferred_clearance_m);
  if (!root) return std::nullopt;
  to_goal_.update(usual.roadmap(), *root);
  query.clearance_m = usual.clearance_m();
  query.steepest_rad = steepest_rad_;
  query.worth_s_per_m3 =
      exploring_s ? kWorth * std::max(kShortest_s, *exploring_s) / std::max(kLeast_m3, map.free_volume_m3())
                  : 0;
  std::optional<HorizonPlan> found = plan_horizon(map, usual.roadmap(), to_goal_, rays_, query);
  if (found && map.region()) {
    std::vector<Vec3> flown;
    for (const TrajectorySample& s : found->samples) flown.push_back(s.position);
    if (world.leads_too_far(usual, flown)) return std::nullopt;
  }
  return found;
}

}  // namespace karst::core
