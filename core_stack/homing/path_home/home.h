// The way home along the known map, and how long it takes: asked every second of a flight, so that the
// vehicle turns back in time.
#pragma once
#include <optional>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/roadmap/distance_tree.h"
#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {

/// The ways home from everywhere, kept as the map changes: asking takes well below a millisecond for the
/// length and a few for the way, kilometres from home.
class PathHome {
 public:
  /// To be called after each update of the roadmap, which is always the same one. A home that is not clear is
  /// approached as near as two preferred clearances.
  void update(const VoxelMap& map, const Roadmap& roadmap, const Vec3& home, const PlanningOptions& options);
  /// Length of the shortest way home through the roadmap; nothing if none is known.
  std::optional<double> length_m(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from) const;
  /// That way, to the place where home is approached; raw: pass it to plan_along.
  Path find(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from) const;

 private:
  DistanceTree tree_;
  bool known_ = false;
  double rest_m_ = 0;  // from the place of approach
};

/// The speed that is held on the way, as a mean over bends and turns.
double cruise_speed_mps(const MotionLimits& limits);

/// Time to fly `length_m` from rest to rest. The speed held on the way is taken as a share of the greatest
/// that caves with bends allow.
double flight_time_s(double length_m, const MotionLimits& limits);

/// Time to fly `length_m` home and to descend there from home_z_m to ground_z_m.
double home_time_s(double length_m, double ground_z_m, double home_z_m, const MotionLimits& limits,
                   double landing_speed_mps);

/// Seconds left before the vehicle must turn back: the time left, less the way home with `margin` (a share of
/// its time) and a fixed reserve. Negative: too late.
double home_slack_s(double seconds_left, double home_time_s, double margin, double reserve_s);

/// When to turn back, asked once a second: as soon as there is no slack. Slack that goes at once, and not as
/// one flies on, must be gone for three seconds more: noise shuts a passage in the map for a moment, and then
/// the way home seems to lead around half the cave.
class ReturnTrigger {
 public:
  bool due(double slack_s);

 private:
  double before_s_ = 0;  // when there was some
  int doubted_ = 0;
};

}  // namespace karst::core
