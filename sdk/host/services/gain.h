// Information gain: unknown cells a sensor would see from a viewpoint.
#pragma once
#include <string>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "sdk/abi/karst_abi_services.h"

namespace karst::host {

/// "" if the model makes sense, otherwise what is wrong with it.
std::string sensor_fault(const karst_sensor_t& sensor);
/// "" if a look of a sound sensor into a map of this resolution keeps within the service's limits (memory
/// grows with the cube of the range in cells), otherwise which one it exceeds.
std::string sensor_excess(const karst_sensor_t& sensor, double resolution_m);

/// A sensor's rays in its own frame, spread so that at its range neighbours are at most a cell apart.
class SensorRays {
 public:
  SensorRays(const karst_sensor_t& sensor, double resolution_m);

  /// Unknown cells within range whose ray from the viewpoint meets no occupied cell before. Unknown cells are
  /// transparent; each is counted once.
  std::uint64_t newly_seen(const core::VoxelMap& map, const karst_viewpoint_t& from) const;

 private:
  core::Pose T_body_sensor_;
  double min_range_m_, max_range_m_;
  std::vector<core::Vec3> directions_;  // unit
};

}  // namespace karst::host
