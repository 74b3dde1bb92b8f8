// View gain: how much unknown space the sensors will see from poses along a motion.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// A sample of the sensors' view, in the frame of the level body.
struct ViewRay {
  Vec3 direction = Vec3::UnitX();  // unit vector
  double range_m = 0;
  double solid_angle_sr = 0;  // that it stands for
};

/// Rays about 6 degrees apart that fill the view of all cameras and of the LiDAR.
std::vector<ViewRay> view_rays(const VehicleDescription& vehicle);

/// A level pose.
struct ViewPose {
  Vec3 position = Vec3::Zero();
  double heading_rad = 0;
};

/// A copy of the map around a place, for many thousand views. It holds at most 129 cells a side; rays end at
/// its boundary.
class ViewMap {
 public:
  /// For views from up to `reach_m` away from the center. Where rays are longer than 30 of the map's cells, a
  /// cell stands for 2 x 2 x 2 of them: it is rock if one is, and free if half are known to be. The rays
  /// outlive the view map.
  ViewMap(const VoxelMap& map, const Vec3& center, double reach_m, std::span<const ViewRay> rays);

  /// The unknown volume in m^3 that will be seen from `poses`. Each cell counts once. A ray ends at rock.
  /// Volume behind the first unknown cell of a ray counts less with depth, by a factor of e every
  /// kExpected_m: rock is near. The view is that from the middle of a pose's cell, with its heading rounded
  /// to the spacing of rays, so that near poses share it.
  double gain_m3(std::span<const ViewPose> poses);

  static constexpr double kExpected_m = 1.5;

 private:
  /// An unknown cell on a ray, and the volume that it counts for.
  struct Sight {
    std::uint32_t cell;
    float volume_m3;
  };
  void leave_out_beyond(const FlightRegion& region);
  std::size_t index_of(const CellKey& k) const;
  bool holds(const CellKey& k) const;
  const std::vector<Sight>& view_from(const ViewPose& pose);
  std::vector<Sight> look(const CellKey& cell, double heading_rad) const;

  std::span<const ViewRay> rays_;
  double resolution_m_ = 0;
  CellKey low_;
  std::int32_t edge_;
  std::vector<Cell> cells_;
  std::unordered_map<std::uint64_t, std::vector<Sight>> views_;
  std::vector<std::uint32_t> seen_by_;  // number of the last pose that counted the cell
  std::uint32_t last_pose_ = 0;
};

}  // namespace karst::core
