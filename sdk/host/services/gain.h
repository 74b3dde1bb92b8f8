// Information gain: the number of unknown cells that a sensor would see from a viewpoint.
#pragma once
#include <string>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "sdk/abi/karst_abi_services.h"

namespace karst::host {

/// "" if the sensor model is valid, otherwise what is wrong with it.
std::string sensor_fault(const karst_sensor_t& sensor);
/// "" if the view of a valid sensor into a map of this resolution keeps within the service's limits (memory
/// grows with the cube of the range in cells), otherwise the limit that it exceeds.
std::string sensor_excess(const karst_sensor_t& sensor, double resolution_m);

/// A sensor's rays in its own frame, spaced so that neighbours are at most a cell apart at its range.
class SensorRays {
 public:
  SensorRays(const karst_sensor_t& sensor, double resolution_m);

  /// Number of unknown cells within range that a ray from the viewpoint reaches without meeting an occupied
  /// cell. Unknown cells are transparent; each is counted once.
  std::uint64_t newly_seen(const core::VoxelMap& map, const karst_viewpoint_t& from);
  const std::vector<core::Vec3>& directions() const { return directions_; }

 private:
  void turn(const core::Quat& T_world_sensor);

  core::Pose T_body_sensor_;
  double min_range_m_, max_range_m_;
  std::vector<core::Vec3> directions_;  // unit
  // Of the last viewpoint; the memory is kept for the next one.
  std::vector<double> turned_;
  core::Vec3 low_, high_;  // bounds of the turned directions, the eye included
  std::vector<std::uint8_t> bytes_;
};

}  // namespace karst::host
