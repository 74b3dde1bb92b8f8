#include "plugins/simulator/cave_generator/surface_net.h"

#include <cmath>

namespace karst::cave {
namespace {

using core::Vec3;

constexpr std::uint32_t kNoVertex = ~std::uint32_t{0};
constexpr std::array<Node, 3> kAxes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

Node minus(const Node& a, const Node& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// Mean of the surface's crossings of a cell's twelve edges; false if it crosses none.
bool cell_vertex(const Samples& s, const Node& cell, Vec3& out) {
  std::array<float, 8> v;
  int hollow = 0;
  for (int i = 0; i < 8; ++i) {
    v[static_cast<std::size_t>(i)] = s.at(cell + Node{i & 1, i >> 1 & 1, i >> 2 & 1});
    hollow += v[static_cast<std::size_t>(i)] < 0;
  }
  if (hollow == 0 || hollow == 8) return false;
  Vec3 sum = Vec3::Zero();
  int crossings = 0;
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      if (i >> axis & 1) continue;
      const double a = v[static_cast<std::size_t>(i)], b = v[static_cast<std::size_t>(i | 1 << axis)];
      if ((a < 0) == (b < 0)) continue;
      Vec3 p(i & 1, i >> 1 & 1, i >> 2 & 1);
      p[axis] = a / (a - b);
      sum += p;
      ++crossings;
    }
  out = s.position(cell) + s.grid_m() * sum / crossings;
  return true;
}

}  // namespace

TriangleMesh surface_net(const Samples& s) {
  TriangleMesh mesh;
  std::vector<std::vector<std::uint32_t>> ids(s.block_count());
  s.for_each([&](const Node& cell) {
    Vec3 p;
    if (!cell_vertex(s, cell, p)) return;
    std::vector<std::uint32_t>& block = ids[s.block_of(cell)];
    if (block.empty()) block.assign(Samples::kEdge * Samples::kEdge * Samples::kEdge, kNoVertex);
    block[Samples::inside(cell)] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(p.cast<float>());
  });
  const auto id = [&](const Node& cell) { return ids[s.block_of(cell)][Samples::inside(cell)]; };
  s.for_each([&](const Node& n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool here = s.hollow(n);
      if (here == s.hollow(n + kAxes[axis])) continue;
      const Node &u = kAxes[(axis + 1) % 3], &v = kAxes[(axis + 2) % 3];
      // Counter-clockwise seen along the axis; reversed where the cave is on the near side.
      std::array<std::uint32_t, 4> q{id(minus(minus(n, u), v)), id(minus(n, v)), id(n), id(minus(n, u))};
      if (here) std::swap(q[1], q[3]);
      const auto length = [&](std::size_t a, std::size_t b) {
        return (mesh.vertices[q[a]] - mesh.vertices[q[b]]).squaredNorm();
      };
      if (length(0, 2) <= length(1, 3)) {
        mesh.triangles.push_back({q[0], q[1], q[2]});
        mesh.triangles.push_back({q[0], q[2], q[3]});
      } else {
        mesh.triangles.push_back({q[0], q[1], q[3]});
        mesh.triangles.push_back({q[1], q[2], q[3]});
      }
    }
  });
  return mesh;
}

}  // namespace karst::cave
