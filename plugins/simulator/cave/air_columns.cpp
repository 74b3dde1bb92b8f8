#include "plugins/simulator/cave/air_columns.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/random.h"

namespace karst::cave {

using core::Vec3;

namespace {

struct SurfacePiece {
  Vec3 a, ab, ac;
  /// As seen from above.
  double plan_area_m2() const { return std::abs(ab.x() * ac.y() - ab.y() * ac.x()) / 2; }
};

SurfacePiece surface_piece(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3 a = mesh.vertices[t[0]].cast<double>();
  return {a, mesh.vertices[t[1]].cast<double>() - a, mesh.vertices[t[2]].cast<double>() - a};
}

Vec3 any_place_on(const SurfacePiece& s, core::Random& random) {
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return s.a + u * s.ab + v * s.ac;
}

void append_columns(const RayScene& scene, const Vec3& below, std::vector<AirColumn>& out) {
  const core::Vec3f origin = below.cast<float>();
  const std::vector<double> surfaces = scene.surfaces({origin, core::Vec3f::UnitZ()});
  if (surfaces.size() % 2 != 0) return;
  for (std::size_t i = 0; i < surfaces.size(); i += 2)
    out.push_back({origin.cast<double>() + Vec3(0, 0, surfaces[i]), surfaces[i + 1] - surfaces[i]});
}

}  // namespace

std::vector<AirColumn> air_columns(const RayScene& scene, int lines) {
  const TriangleMesh& mesh = scene.mesh();
  double all_m2 = 0, lowest = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) all_m2 += surface_piece(mesh, i).plan_area_m2();
  for (const core::Vec3f& v : mesh.vertices) lowest = std::min(lowest, static_cast<double>(v.z()));
  std::vector<AirColumn> columns;
  if (!(all_m2 > 0) || lines < 1) return columns;
  core::Random random(1);
  const double step_m2 = all_m2 / lines;
  double due_m2 = step_m2 / 2;  // area to pass until the next line
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const SurfacePiece piece = surface_piece(mesh, i);
    for (due_m2 -= piece.plan_area_m2(); due_m2 < 0; due_m2 += step_m2) {
      const Vec3 p = any_place_on(piece, random);
      append_columns(scene, {p.x(), p.y(), lowest - 1}, columns);
    }
  }
  return columns;
}

}  // namespace karst::cave
