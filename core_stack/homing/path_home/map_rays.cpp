#include "core_stack/homing/path_home/map_rays.h"

#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "core_stack/planning/free_space/segment_rows.h"

namespace karst::core {

FreeRay free_rays(const Roadmap& roadmap, double clearance_m) {
  return [&roadmap, clearance_m](const Vec3& a, const Vec3& b) {
    return roadmap.segment_clear(a, b, clearance_m);
  };
}

FreeRay rock_rays(const VoxelMap& map, double clearance_m) {
  return [&map, clearance_m](const Vec3& a, const Vec3& b) {
    const double res = map.resolution_m();
    const Vec3 half = Vec3::Constant(0.5);
    VoxelReader reader(map);
    return !all_rows_near_segment(
        a / res - half, b / res - half, clearance_m / res,
        [&reader](std::int32_t low, std::int32_t high, std::int32_t y, std::int32_t z) {
          for (std::int32_t x = low; x <= high; ++x)
            if (reader.at({x, y, z}) == Cell::occupied) return false;
          return true;
        });
  };
}

}  // namespace karst::core
