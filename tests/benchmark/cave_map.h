// The map a vehicle has of a cave it has seen all of: every cell that touches a triangle is occupied, every
// other cell connected with the start is free.
#pragma once
#include <cmath>
#include <stdexcept>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/evaluation/reachable/triangle_cells.h"

namespace karst::core::bench {

struct CaveMap {
  VoxelMap map{MapOptions{}};
  std::vector<CellKey> free;  // in a fixed order
};

inline CaveMap map_of_cave(const cave::TriangleMesh& mesh, const Vec3& start) {
  CaveMap out;
  const double res = out.map.resolution_m();
  Vec3 low = Vec3::Constant(1e9), high = -low;
  for (const Vec3f& v : mesh.vertices)
    low = low.cwiseMin(v.cast<double>()), high = high.cwiseMax(v.cast<double>());
  const Vec3 spare = Vec3::Constant(2 * 8 * res);
  evaluation::CellSet rock(out.map.key_of(low - spare), out.map.key_of(high + spare));
  for (const auto& t : mesh.triangles)
    evaluation::insert_touched(rock,
                               {mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
                                mesh.vertices[t[2]].cast<double>()},
                               res);
  const std::optional<evaluation::CellSet> free = evaluation::flood_between(rock, out.map.key_of(start));
  if (!free) throw std::runtime_error("the cave is open");
  free->for_each([&](const CellKey& k) { out.free.push_back(k); });
  for (const CellKey& k : out.free) out.map.assign(k, 1, -1.0f);
  for (const CellKey& k : out.free)
    for (int i = 0; i < 27; ++i) {
      const CellKey n = k + CellKey{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
      if (rock.contains(n)) out.map.assign(n, 1, 1.0f);
    }
  return out;
}

}  // namespace karst::core::bench
