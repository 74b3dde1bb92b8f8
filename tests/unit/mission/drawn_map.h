// Maps for the mission's tests: a box of free space cut into unknown space, with walls where asked.
#pragma once
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// Makes every cell of the box known: free inside, occupied on the faces that are not in `open` ("x+", "x-",
/// "y+", ...). A ray a cell, from its centre: a hit there, or a miss on the way to the cell above.
inline std::vector<Ray> box_rays(const VoxelMap& map, const Vec3& low, const Vec3& high,
                                 const std::vector<std::string>& open = {}) {
  const double r = map.resolution_m();
  const CellKey a = map.key_of(low + Vec3::Constant(r / 2)), b = map.key_of(high - Vec3::Constant(r / 2));
  const auto is_open = [&](const char* face) {
    return std::find(open.begin(), open.end(), face) != open.end();
  };
  std::vector<Ray> rays;
  const auto add = [&](const CellKey& k, bool hit) {
    const Vec3f c = map.center_of(k).cast<float>();
    rays.push_back(hit ? Ray{c, c, true} : Ray{c, c + Vec3f(0, 0, static_cast<float>(r)), false});
  };
  for (int x = a.x; x <= b.x; ++x)
    for (int y = a.y; y <= b.y; ++y)
      for (int z = a.z; z <= b.z; ++z) {
        const bool wall = (x == a.x && !is_open("x-")) || (x == b.x && !is_open("x+")) ||
                          (y == a.y && !is_open("y-")) || (y == b.y && !is_open("y+")) ||
                          (z == a.z && !is_open("z-")) || (z == b.z && !is_open("z+"));
        add({x, y, z}, wall);
      }
  return rays;
}

inline void carve_box(VoxelMap& map, const Vec3& low, const Vec3& high,
                      const std::vector<std::string>& open = {}) {
  map.insert(box_rays(map, low, high, open));
}

}  // namespace karst::core
