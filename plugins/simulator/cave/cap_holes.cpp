#include "plugins/simulator/cave/cap_holes.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "plugins/simulator/cave/preflight.h"

namespace karst::cave {

using core::Vec3;

namespace {

using Flat = Eigen::Vector2d;
using Ear = std::array<std::size_t, 3>;  // numbers of corners

double cross(const Flat& a, const Flat& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The corners in the loop's plane; the loop runs counter-clockwise there.
std::vector<Flat> in_plane(const BoundaryLoop& loop, const TriangleMesh& mesh) {
  const Vec3 u = loop.normal.unitOrthogonal(), v = loop.normal.cross(u);
  std::vector<Flat> corners;
  for (const std::uint32_t i : loop.vertices) {
    const Vec3 p = mesh.vertices[i].cast<double>() - loop.centre;
    corners.emplace_back(p.dot(u), p.dot(v));
  }
  return corners;
}

/// Cross products of less than `rounding_m2` count as 0: corners on a line make no ear, and no ear passes
/// through a corner.
bool is_ear(const std::vector<Flat>& corners, const std::vector<std::size_t>& left, const Ear& ear,
            double rounding_m2) {
  const Flat &a = corners[ear[0]], &b = corners[ear[1]], &c = corners[ear[2]];
  if (cross(b - a, c - a) <= rounding_m2) return false;
  return std::none_of(left.begin(), left.end(), [&](std::size_t i) {
    if (i == ear[0] || i == ear[1] || i == ear[2]) return false;
    const Flat& p = corners[i];
    return cross(b - a, p - a) >= -rounding_m2 && cross(c - b, p - b) >= -rounding_m2 &&
           cross(a - c, p - c) >= -rounding_m2;
  });
}

/// None if the polygon crosses itself, or has too many corners for a method of quadratic time.
std::optional<std::vector<Ear>> clipped_ears(const std::vector<Flat>& corners, double diameter_m) {
  constexpr std::size_t kMostCorners = 5000;
  const double rounding_m2 = 1e-12 * diameter_m * diameter_m;
  if (corners.size() > kMostCorners) return std::nullopt;
  std::vector<std::size_t> left(corners.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<Ear> ears;
  std::size_t at = 0, without_ear = 0;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    at %= n;
    const Ear ear{left[(at + n - 1) % n], left[at], left[(at + 1) % n]};
    if (!is_ear(corners, left, ear, rounding_m2)) {
      if (++without_ear > n) return std::nullopt;
      ++at;
      continue;
    }
    without_ear = 0;
    ears.push_back(ear);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    ++at;  // skips a corner: ears all round make better triangles than a fan of one corner
  }
  const Ear last{left[0], left[1], left[2]};
  if (!is_ear(corners, left, last, rounding_m2)) return std::nullopt;
  ears.push_back(last);
  return ears;
}

/// By the areas between the centre and each edge: of a loop that crosses itself, these do not cancel.
bool is_slit(const BoundaryLoop& loop, const TriangleMesh& mesh) {
  constexpr double kRounding = 1e-9;
  double area_m2 = 0;
  for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
    const Vec3 a = mesh.vertices[loop.vertices[i]].cast<double>() - loop.centre,
               b = mesh.vertices[loop.vertices[(i + 1) % loop.vertices.size()]].cast<double>() - loop.centre;
    area_m2 += a.cross(b).norm() / 2;
  }
  return area_m2 <= kRounding * loop.diameter_m * loop.diameter_m;
}

bool is_seam(const RayScene& scene, const BoundaryLoop& loop) {
  constexpr int kRays = 256;
  const Vec3 aside = loop.diameter_m / 4 * loop.normal;
  const auto inside = [&](const Vec3& p) { return look_around(scene, p, kRays).odd_fraction >= 0.5; };
  return inside(loop.centre + aside) && inside(loop.centre - aside);
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> cap_of(const BoundaryLoop& loop, TriangleMesh& mesh) {
  const std::vector<std::uint32_t>& v = loop.vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (const auto ears = clipped_ears(in_plane(loop, mesh), loop.diameter_m)) {
    for (const Ear& ear : *ears) triangles.push_back({v[ear[0]], v[ear[1]], v[ear[2]]});
    return triangles;
  }
  const auto hub = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(loop.centre.cast<float>());
  for (std::size_t i = 0; i < v.size(); ++i) triangles.push_back({v[i], v[(i + 1) % v.size()], hub});
  return triangles;
}

Capped cap_holes(const RayScene& scene, double max_diameter_m) {
  Capped capped{scene.mesh(), {}};
  for (BoundaryLoop& loop : boundary_loops(scene.mesh())) {
    CapOfLoop& c = capped.loops.emplace_back(CapOfLoop{std::move(loop), LeftOpen::no});
    if (is_slit(c.loop, scene.mesh()))
      c.left = LeftOpen::slit;
    else if (c.loop.diameter_m > max_diameter_m)
      c.left = LeftOpen::too_large;
    else if (is_seam(scene, c.loop))
      c.left = LeftOpen::seam;
    if (c.left != LeftOpen::no) continue;
    const auto cap = cap_of(c.loop, capped.mesh);
    capped.mesh.triangles.insert(capped.mesh.triangles.end(), cap.begin(), cap.end());
  }
  return capped;
}

}  // namespace karst::cave
