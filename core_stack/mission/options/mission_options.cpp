#include "core_stack/mission/options/mission_options.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/rounded.h"

namespace karst::core {

void describe(OptionTable& t, MissionOptions& o) {
  t.add("takeoff_height", o.takeoff_height_m, "m", 0.3, 20,
        "height of the first hover above the launch site");
  t.add("launch_clear_radius", o.launch_clear_radius_m, "m", 0.5, 5,
        "ball around the first hover which the operator vouches to be clear");
  t.add("decision_period", o.decision_period_s, "s", 0.5, 60,
        "the policy is asked again after this long under way, and when a goal is near or has lost its sense; "
        "after 1.5 s with a receding horizon (motion.trajectory)");
  t.add("decision_budget", o.decision_budget_s, "s", 0.05, 2, "simulated time a decision and its plan take");
  t.add("append", o.append,
        "the next goal is chosen under way and its path appended, except with a receding horizon; off: the "
        "vehicle stops at every goal");
  t.add("append_before", o.append_before_s, "s", 0.5, 10,
        "the next goal is asked for this long before the present one is reached");
  t.add("goal_timeout", o.goal_timeout_s, "s", 2, 60, "a goal without progress for this long is abandoned");
  t.add("explored_patience", o.explored_patience_s, "s", 0, 60,
        "a vehicle that has hovered without a goal for this long flies home once the policy says explored");
  t.add("home_margin", o.home_margin, "", 0, 2, "share added to the time estimated for flying home");
  t.add("home_reserve", o.home_reserve_s, "s", 5, 600,
        "time kept for after the way home, of the battery and of mission.max_flight_time");
  t.add("landing_speed", o.landing_speed_mps, "m/s", 0.1, 0.7, "vertical speed of the landing");
  t.add("max_flight_time", o.max_flight_time_s, "s", 10, 86400,
        "homing begins at the latest in time for this");
  t.add("mapping_range", o.mapping_range_m, "m", 1, 200,
        "LiDAR measurements beyond this only clear space up to it");
  t.add("min_open_cells", o.min_open_cells, 0, 1000,
        "a frontier is offered to the policy if so many of its cells have no rock beside them");
}

void describe(OptionTable& t, CoreOptions& o) {
  t.section("mission", o.mission);
  t.section("safety", o.safety);
  t.section("map", o.map);
  t.section("frontiers", o.frontiers);
  t.section("perception", o.perception);
  t.section("localization", o.localization);
  t.section("objects", o.objects);
  t.section("planning", o.planning);
  t.section("motion", o.motion);
  t.section("tracker", o.tracker);
  t.section("controller", o.controller);
}

void check(const CoreOptions& o, const VehicleDescription& vehicle) {
  const auto refuse = [](const std::string& key, const std::string& reason) {
    throw InputError("mission", key, reason);
  };
  const auto metres = [](double m) { return std::to_string(m).substr(0, 5) + " m"; };
  if (o.motion.min_speed_mps > o.motion.max_speed_mps)
    refuse("motion.min_speed", "is greater than motion.max_speed, " +
                                   std::to_string(o.motion.max_speed_mps).substr(0, 5) + " m/s");
  if (!vehicle.pose_sensor && (o.localization.source == PoseSource::pose_sensor || !vehicle.lidar))
    refuse("localization.source", "the vehicle " + vehicle.name + " has no pose sensor" +
                                      (vehicle.lidar ? "" : ", nor a LiDAR to locate itself with"));
  if (o.earlier.map && !vehicle.lidar)
    refuse("map.start", "the vehicle " + vehicle.name +
                            " has no LiDAR, without which it cannot find its place in an earlier map");
  if (o.earlier.map && std::abs(o.earlier.map->piece.resolution_m / o.map.resolution_m - 1) > 0.01)
    refuse("map.start", o.earlier.map->name + " has cells of " + metres(o.earlier.map->piece.resolution_m) +
                            ", and map.resolution is " + metres(o.map.resolution_m));
  // Obstacles are cells, whose surface may lie half an edge nearer than their centre.
  const double min_m = vehicle.radius_m + o.map.resolution_m / 2;
  if (o.planning.clearance_m < min_m)
    refuse("planning.clearance", metres(o.planning.clearance_m) +
                                     " is less than the vehicle's radius and half a cell, " + metres(min_m));
  // An error rather than silently off: a margin asks for passages narrower than the clearance allows.
  // Where refining cannot reach the full clearance, a quarter of a cell less must suffice.
  if (const double least = o.map.resolution_m / 4;
      o.planning.narrow_margin_m > 0 && o.planning.narrow_margin_m < least)
    refuse("planning.narrow_margin", metres(o.planning.narrow_margin_m) +
                                         " is less than a quarter of a cell, " + metres(least) +
                                         "; 0 switches it off");
  if (const double narrow_m = vehicle.radius_m + o.planning.narrow_margin_m;
      o.planning.narrow_margin_m > 0 && narrow_m >= o.planning.clearance_m)
    refuse("planning.narrow_margin", "with the vehicle's radius it makes " + metres(narrow_m) +
                                         ", which is no less than planning.clearance, " +
                                         metres(o.planning.clearance_m));
  constexpr double kMaxCells = 14;  // the largest clearance of the bitmap planner
  for (const auto& [key, clearance_m] :
       {std::pair{"planning.clearance", o.planning.clearance_m},
        std::pair{"planning.preferred_clearance", o.planning.preferred_clearance_m}})
    if (clearance_m > kMaxCells * o.map.resolution_m)
      refuse(key, metres(clearance_m) + " is more than " + std::to_string(static_cast<int>(kMaxCells)) +
                      " cells of map.resolution (" + metres(o.map.resolution_m) +
                      "): choose coarser cells or less clearance");
}

void check_region(const std::string& source, const CoreOptions& o, const VehicleDescription& vehicle) {
  if (!o.region) return;
  // Home is the first hover: the path there from the ground, and about it the room for a path at all.
  if (const double least_m = o.mission.takeoff_height_m + o.planning.clearance_m;
      o.region->limits().max_home_m.value_or(least_m) < least_m)
    throw InputError(source, "region.max_home_distance",
                     format_text("is %.2f m, and the vehicle could fly nowhere: expected at least %.2f m "
                                 "(mission.takeoff_height and planning.clearance), or 0 for no limit",
                                 *o.region->limits().max_home_m, least_m));
  const Vec3& start = vehicle.T_world_start.position;
  const auto require = [&](const Vec3& p, double least_m, const char* what) {
    const double depth_m = o.region->depth_m(p);
    if (depth_m >= least_m) return;
    throw InputError(
        source, o.region->nearest_part(p),
        format_text("leaves no room for %s at (%.2f, %.2f, %.2f): %.2f m from its border%s, where "
                    "%.2f m are needed",
                    what, to_hundredths(p.x()), to_hundredths(p.y()), to_hundredths(p.z()), std::abs(depth_m),
                    depth_m < 0 ? " and outside" : "", least_m));
  };
  require(start, vehicle.radius_m, "the vehicle's start");
  constexpr double kStep_m = 0.05;
  const double top_m = o.mission.takeoff_height_m;
  for (double up_m = kStep_m; up_m < top_m; up_m += kStep_m)
    require(start + Vec3(0, 0, up_m), vehicle.radius_m, "the take-off");
  require(start + Vec3(0, 0, top_m), min_hover_depth_m(o), "the first hover");
}

/// Its clearance and the margin. A cell may reach half its diagonal beyond.
double min_hover_depth_m(const CoreOptions& o) {
  return o.planning.clearance_m + o.region->limits().margin_m + 0.87 * o.map.resolution_m;
}

}  // namespace karst::core
