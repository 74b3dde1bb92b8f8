// Closed meshes made of axis-aligned boxes.
#pragma once
#include <set>

#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::test {

/// Surface of a union of unit-lattice cells scaled by `edge_m` and moved by `offset`: a face for each pair of
/// a cell inside and one outside.
inline cave::TriangleMesh lattice_mesh(const std::set<std::array<int, 3>>& cells, double edge_m,
                                       const core::Vec3& offset) {
  cave::TriangleMesh mesh;
  for (const auto& c : cells)
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        auto next = c;
        next[axis] += side ? 1 : -1;
        if (cells.count(next)) continue;
        std::array<int, 3> corner = c;
        corner[axis] += side;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const auto& [du, dv] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
          auto p = corner;
          p[u] += du;
          p[v] += dv;
          mesh.vertices.push_back((offset + edge_m * core::Vec3(p[0], p[1], p[2])).cast<float>());
        }
        const std::uint32_t second = side ? base + 1 : base + 3, last = side ? base + 3 : base + 1;
        mesh.triangles.push_back({base, second, base + 2});
        mesh.triangles.push_back({base, base + 2, last});
      }
  return mesh;
}

/// Cells of a box from `low` up to, not including, `high`.
inline void fill(std::set<std::array<int, 3>>& cells, std::array<int, 3> low, std::array<int, 3> high) {
  for (int z = low[2]; z < high[2]; ++z)
    for (int y = low[1]; y < high[1]; ++y)
      for (int x = low[0]; x < high[0]; ++x) cells.insert({x, y, z});
}

}  // namespace karst::test
