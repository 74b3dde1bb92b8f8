// Finds the nodes near a position: a spatial hash of cubes, best with an edge of the greatest query radius.
#pragma once
#include <algorithm>
#include <unordered_map>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

class PlaceGrid {
 public:
  explicit PlaceGrid(double cube_m) : cube_m_(cube_m) {}

  void add(std::uint32_t index, const Vec3& p) { cubes_[cube_of(p)].push_back({index, p}); }
  void remove(std::uint32_t index, const Vec3& p) {
    std::erase_if(cubes_[cube_of(p)], [index](const Entry& e) { return e.index == index; });
  }
  /// Calls f(index, position) for all nodes in the closed box, cube by cube, in a cube in order of insertion.
  template <class F>
  void for_each_in_box(const Vec3& low, const Vec3& high, F&& f) const {
    const CellKey a = cube_of(low), b = cube_of(high);
    for (std::int32_t z = a.z; z <= b.z; ++z)
      for (std::int32_t y = a.y; y <= b.y; ++y)
        for (std::int32_t x = a.x; x <= b.x; ++x) {
          const auto cube = cubes_.find({x, y, z});
          if (cube == cubes_.end()) continue;
          for (const Entry& e : cube->second)
            if ((e.p.array() >= low.array()).all() && (e.p.array() <= high.array()).all()) f(e.index, e.p);
        }
  }
  /// The same for all nodes within `radius_m` of p.
  template <class F>
  void for_each_within(const Vec3& p, double radius_m, F&& f) const {
    const Vec3 radius = Vec3::Constant(radius_m);
    for_each_in_box(p - radius, p + radius, [&](std::uint32_t index, const Vec3& q) {
      if ((q - p).squaredNorm() <= radius_m * radius_m) f(index, q);
    });
  }

 private:
  struct Entry {
    std::uint32_t index;
    Vec3 p;
  };
  CellKey cube_of(const Vec3& p) const {
    const Vec3 k = (p / cube_m_).array().floor();
    return {static_cast<std::int32_t>(k.x()), static_cast<std::int32_t>(k.y()),
            static_cast<std::int32_t>(k.z())};
  }

  double cube_m_;
  std::unordered_map<CellKey, std::vector<Entry>, CellKeyHash> cubes_;
};

}  // namespace karst::core
