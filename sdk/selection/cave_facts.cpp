#include "sdk/selection/cave_facts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "plugins/simulator/cave/joined_vertices.h"

namespace karst::selection {
namespace {

using core::Vec3;
using core::Vec3f;

std::array<double, 3> percentiles(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double fraction) {
    return values[static_cast<std::size_t>(fraction * double(values.size() - 1))];
  };
  return {at(0.1), at(0.5), at(0.9)};
}

}  // namespace

MeshFacts mesh_facts(const cave::TriangleMesh& mesh) {
  MeshFacts facts;
  facts.triangles = mesh.triangles.size();
  if (mesh.vertices.empty()) return facts;
  const std::vector<std::uint32_t> first = cave::first_at_position(mesh);
  // Each edge once per triangle: the lower number first, and whether the triangle runs along it that way.
  std::vector<std::array<std::uint32_t, 3>> runs;
  runs.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = first[t[i]], b = first[t[(i + 1) % 3]];
      runs.push_back({std::min(a, b), std::max(a, b), a < b ? 1u : 0u});
    }
  std::sort(runs.begin(), runs.end());
  for (std::size_t i = 0, end = 0; i < runs.size(); i = end) {
    while (end < runs.size() && runs[end][0] == runs[i][0] && runs[end][1] == runs[i][1]) ++end;
    ++facts.edges;
    if (end - i != 2)
      ++facts.odd_edges;
    else if (runs[i][2] == runs[i + 1][2])
      ++facts.flipped_edges;
  }
  facts.low = facts.high = mesh.vertices.front().cast<double>();
  for (const Vec3f& v : mesh.vertices) {
    facts.low = facts.low.cwiseMin(v.cast<double>());
    facts.high = facts.high.cwiseMax(v.cast<double>());
  }
  return facts;
}

PassageFacts passage_facts(const cave::RayScene& scene, const evaluation::Reachable& reachable) {
  constexpr std::size_t kPlaces = 2000;
  constexpr double kFarM = 200;
  const std::size_t stride = std::max<std::size_t>(1, reachable.flyable_cells / kPlaces);
  std::vector<double> widths, heights;
  std::size_t n = 0;
  const double edge = reachable.options.resolution_m;
  reachable.flyable.for_each([&](const core::CellKey& k) {
    if (n++ % stride != 0) return;
    const Vec3 p = edge * Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5);
    const auto chord = [&](const Vec3& d) {
      return std::min(scene.ray_cast(p, d, kFarM), kFarM) + std::min(scene.ray_cast(p, -d, kFarM), kFarM);
    };
    double width = 2 * kFarM;
    for (int i = 0; i < 10; ++i) {
      const double a = i * std::numbers::pi / 10;
      width = std::min(width, chord({std::cos(a), std::sin(a), 0}));
    }
    widths.push_back(width);
    heights.push_back(chord(Vec3::UnitZ()));
  });
  return {percentiles(std::move(widths)), percentiles(std::move(heights))};
}

}  // namespace karst::selection
