// The path home through the known map, and its flight time. It is evaluated every second of a flight, so that
// the vehicle turns back in time.
#pragma once
#include <optional>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/roadmap/distance_tree.h"
#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {

/// The shortest paths home from all places, maintained as the map changes. A query kilometres from home takes
/// well below a millisecond for the length, and a few milliseconds for the path.
class PathHome {
 public:
  /// Call after each update of the roadmap, which must always be the same one. If home itself is not clear,
  /// paths end within two preferred clearances of it.
  void update(const VoxelMap& map, const Roadmap& roadmap, const Vec3& home, const PlanningOptions& options);
  /// Length of the shortest path home through the roadmap; nothing if none is known.
  std::optional<double> length_m(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from) const;
  /// That path, up to the approach point of home. It is raw: pass it to plan_along.
  Path find(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from) const;

 private:
  DistanceTree tree_;
  bool known_ = false;
  double rest_m_ = 0;  // from the approach point to home
};

/// The mean speed along a path with bends and turns.
double cruise_speed_mps(const MotionLimits& limits);

/// Time to fly `length_m` from rest to rest. The cruise speed is a fraction of the maximum, as bends in caves
/// allow no more.
double flight_time_s(double length_m, const MotionLimits& limits);

/// Time to fly `length_m` home and to descend there from home_z_m to ground_z_m.
double home_time_s(double length_m, double ground_z_m, double home_z_m, const MotionLimits& limits,
                   double landing_speed_mps);

/// Seconds left before the vehicle must turn back: the time left, less the time home with `margin` (a
/// fraction of it) and a fixed reserve. Negative: too late.
double home_slack_s(double seconds_left, double home_time_s, double margin, double reserve_s);

/// Decides when to turn back; ask it once a second. It triggers as soon as there is no slack. If the slack
/// vanishes abruptly rather than gradually, it must stay gone for three more seconds: noise can close a
/// passage in the map for a moment, and the path home then seems to lead around half the cave.
class ReturnTrigger {
 public:
  bool due(double slack_s);

 private:
  double before_s_ = 0;  // the last positive slack
  int doubted_ = 0;
};

}  // namespace karst::core
