// Messages made of single values of a flight's record, for exports and for flights that are followed.
#pragma once
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "sdk/evaluation/record/poses.h"
#include "sdk/mcap_export/flight_clock.h"
#include "sdk/mcap_export/ros_messages.h"

namespace karst::mcap {

/// The transform from the map to a body, for /tf.
ros::TFMessage tf_of(const evaluation::StampedPose& pose, const FlightClock& clock, const char* body_frame);

struct PoseSigmas {
  double position_m = 0, heading_rad = 0;
};

/// A pose with its motion from the pose before to the pose after, which at the ends of a flight is the pose
/// itself.
struct PoseInFlight {
  const evaluation::StampedPose &before, &pose, &after;
};

/// `velocity_mps`: the estimator's own, in the world frame. Sigmas that are not known leave the covariance 0;
/// roll and pitch have the heading's, an upper bound.
ros::Odometry odometry_of(const PoseInFlight& in_flight, const FlightClock& clock, const char* body_frame,
                          const std::optional<core::Vec3>& velocity_mps,
                          const std::optional<PoseSigmas>& sigmas);

/// Rounding of the record's times, which have two decimals or three.
constexpr double kTimeRounding_s = 0.006;
/// How far a line of telemetry may be from a pose whose velocity it tells.
constexpr double kSameTime_s = 0.01;

/// A flown path of poses a step apart: a vehicle that hovers adds none.
class FlownPath {
 public:
  void add(const evaluation::StampedPose& pose, const FlightClock& clock);
  /// The path until then, stamped so.
  ros::Path until(double t_s, const FlightClock& clock) const;

 private:
  std::optional<core::Vec3> last_;
  std::vector<ros::PoseStamped> poses_;
};

ros::BatteryState battery_of(double t_s, double fraction, const FlightClock& clock);
/// Which lines of telemetry become a message: once a second is enough of what changes by a thousandth in it.
class BatteryPace {
 public:
  bool takes(double t_s, double fraction);

 private:
  std::optional<double> last_s_;
};

/// A cloud of the map's cells, without any yet: x y z, and since when they are occupied.
ros::PointCloud2 cells_cloud(double t_s, const FlightClock& clock);
/// The centre of a cell, and the flight time from which it has been occupied.
void append_cell(ros::PointCloud2& cloud, const core::CellKey& key, double resolution_m, double since_s);
/// A whole map, as it was stored. `since_s` gives the time of each cell, NaN where it is not known.
ros::PointCloud2 map_cloud(const core::VoxelMap& map, double t_s, const FlightClock& clock,
                           const std::function<double(const core::CellKey&)>& since_s);
inline double seconds_of_ms(std::int32_t ms) { return ms / 1000.0; }

/// /map/new tells at the end of each step what became occupied in it.
constexpr double kNewCellsStep_s = 1;
inline std::int64_t new_cells_step(std::int32_t ms) {
  return static_cast<std::int64_t>(std::ceil(seconds_of_ms(ms) / kNewCellsStep_s));
}

}  // namespace karst::mcap
