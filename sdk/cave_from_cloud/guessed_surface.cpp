#include "sdk/cave_from_cloud/guessed_surface.h"

#include <algorithm>
#include <cstdint>

#include "sdk/cave_from_cloud/mesh_parts.h"

namespace karst::from_cloud {

std::vector<bool> guessed_triangles(const cave::TriangleMesh& mesh, const core::PointTree& measured,
                                    double beyond_m) {
  std::vector<bool> far(mesh.vertices.size()), guessed(mesh.triangles.size());
  for (std::size_t i = 0; i < far.size(); ++i) {
    const auto nearest = measured.nearest(mesh.vertices[i].cast<double>());
    far[i] = !nearest || nearest->distance_m > beyond_m;
  }
  for (std::size_t i = 0; i < guessed.size(); ++i) {
    const auto& t = mesh.triangles[i];
    guessed[i] = far[t[0]] && far[t[1]] && far[t[2]];
  }
  return guessed;
}

GuessedSurface guessed_surface(const cave::TriangleMesh& mesh, const std::vector<bool>& guessed) {
  GuessedSurface surface;
  cave::TriangleMesh alone{mesh.vertices, {}};
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    surface.whole_m2 += area_m2(mesh, i);
    if (guessed[i]) alone.triangles.push_back(mesh.triangles[i]);
  }
  const MeshParts parts = parts_of(alone);
  surface.patches.resize(parts.count);
  for (std::size_t i = 0; i < alone.triangles.size(); ++i) {
    const auto& t = alone.triangles[i];
    const double m2 = area_m2(alone, i);
    GuessedPatch& patch = surface.patches[parts.of_triangle[i]];
    patch.area_m2 += m2;
    for (const std::uint32_t v : t) patch.centre += m2 / 3 * mesh.vertices[v].cast<double>();
    surface.area_m2 += m2;
  }
  for (GuessedPatch& p : surface.patches)
    if (p.area_m2 > 0) p.centre /= p.area_m2;
  for (std::size_t i = 0; i < alone.triangles.size(); ++i) {
    GuessedPatch& patch = surface.patches[parts.of_triangle[i]];
    for (const std::uint32_t v : alone.triangles[i])
      patch.diameter_m =
          std::max(patch.diameter_m, 2 * (mesh.vertices[v].cast<double>() - patch.centre).norm());
  }
  std::erase_if(surface.patches, [](const GuessedPatch& p) { return p.area_m2 == 0; });
  std::stable_sort(surface.patches.begin(), surface.patches.end(),
                   [](const GuessedPatch& a, const GuessedPatch& b) { return a.area_m2 > b.area_m2; });
  return surface;
}

}  // namespace karst::from_cloud
