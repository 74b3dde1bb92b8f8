#include "sdk/cave_from_cloud/mesh_parts.h"

#include <array>
#include <cmath>
#include <numbers>

#include "sdk/cave_from_cloud/signed_sets.h"

namespace karst::from_cloud {

using core::Vec3;

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

using TriangleCorners = std::array<Vec3, 3>;

TriangleCorners triangle_corners(const cave::TriangleMesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
          mesh.vertices[t[2]].cast<double>()};
}

/// Signed (Van Oosterom and Strackee, The Solid Angle of a Plane Triangle, 1983).
double solid_angle(const TriangleCorners& corners, const Vec3& place) {
  const Vec3 a = corners[0] - place, b = corners[1] - place, c = corners[2] - place;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

MeshParts parts_of(const cave::TriangleMesh& mesh) {
  SignedSets joined(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    joined.unite(t[0], t[1]);
    joined.unite(t[0], t[2]);
  }
  MeshParts parts;
  std::vector<std::uint32_t> of_root(mesh.vertices.size(), kNone);
  for (const auto& t : mesh.triangles) {
    std::uint32_t& part = of_root[joined.root(t[0]).index];
    if (part == kNone) part = static_cast<std::uint32_t>(parts.count++);
    parts.of_triangle.push_back(part);
  }
  return parts;
}

cave::TriangleMesh part_of(const cave::TriangleMesh& mesh, const MeshParts& parts, std::uint32_t part) {
  cave::TriangleMesh out;
  std::vector<std::uint32_t> moved(mesh.vertices.size(), kNone);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (parts.of_triangle[i] != part) continue;
    std::array<std::uint32_t, 3> t = mesh.triangles[i];
    for (std::uint32_t& v : t) {
      if (moved[v] == kNone) {
        moved[v] = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[v]);
      }
      v = moved[v];
    }
    out.triangles.push_back(t);
  }
  return out;
}

std::vector<double> winding_numbers(const cave::TriangleMesh& mesh, const MeshParts& parts,
                                    const Vec3& place) {
  std::vector<double> windings(parts.count, 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    windings[parts.of_triangle[i]] += solid_angle(triangle_corners(mesh, i), place) / (4 * std::numbers::pi);
  return windings;
}

double area_m2(const cave::TriangleMesh& mesh, std::size_t triangle) {
  const auto [a, b, c] = triangle_corners(mesh, triangle);
  return (b - a).cross(c - a).norm() / 2;
}

}  // namespace karst::from_cloud
