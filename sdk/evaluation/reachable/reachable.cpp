#include "sdk/evaluation/reachable/reachable.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>

#include "core_stack/common/decimal_text.h"
#include "core_stack/common/error.h"
#include "plugins/simulator/cave/boundary_loops.h"
#include "sdk/evaluation/reachable/open_cave.h"
#include "sdk/evaluation/reachable/sight.h"
#include "sdk/evaluation/reachable/triangle_cells.h"

namespace karst::evaluation {
namespace {

using core::InputError;
using core::Vec3;

constexpr double kStartSearchM = 3;
// In cells of 0.2 m: no cave is 105 km across, and in bounds of 10 x 10 x 2.8 km the table of a set's tiles
// takes 64 MiB. The blocks that the bounds of the triangles hold take a minute or two to visit; in a mesh
// that is fine enough to look like rock they are a few per triangle.
constexpr double kMaxBlocksAlong = 65536, kMaxBlocks = 68719476736.0, kMaxBlocksOfTriangles = 4e9;

std::string number_text(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", v);
  return text;
}

std::string place_text(const Vec3& p) { return core::decimal_text(p, 1); }

CellKey key_of(const Vec3& p, double resolution_m) {
  const auto k = [&](double v) { return static_cast<std::int32_t>(std::floor(v / resolution_m)); };
  return {k(p.x()), k(p.y()), k(p.z())};
}

Triangle triangle(const cave::TriangleMesh& mesh, std::size_t i) {
  const auto& t = mesh.triangles[i];
  return {mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
          mesh.vertices[t[2]].cast<double>()};
}

[[noreturn]] void refuse_size(const std::string& name, double resolution_m) {
  throw InputError(name, "", "the mesh is too large for cells of " + number_text(resolution_m) + " m");
}

/// Bounds with more than a block to spare on all sides, so that the outermost blocks hold no rock.
CellSet empty_set_around(const cave::TriangleMesh& mesh, double resolution_m, const std::string& name) {
  if (mesh.triangles.empty()) throw InputError(name, "", "the mesh has no triangles");
  const double block_m = CellSet::kEdge * resolution_m;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  double blocks_of_triangles = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = triangle(mesh, i);
    const Vec3 own_low = t.a.cwiseMin(t.b).cwiseMin(t.c), own_high = t.a.cwiseMax(t.b).cwiseMax(t.c);
    blocks_of_triangles += ((own_high - own_low) / block_m + Vec3::Ones()).prod();
    low = low.cwiseMin(own_low);
    high = high.cwiseMax(own_high);
  }
  const Vec3 blocks = (high - low) / block_m + Vec3::Constant(4);
  if (!blocks.allFinite() || !(blocks.maxCoeff() < kMaxBlocksAlong) || !(blocks.prod() < kMaxBlocks) ||
      !(blocks_of_triangles < kMaxBlocksOfTriangles) ||
      !(low.cwiseAbs().maxCoeff() + high.cwiseAbs().maxCoeff() < 1e9 * resolution_m))
    refuse_size(name, resolution_m);
  const Vec3 spare = Vec3::Constant(2 * block_m);
  return CellSet(key_of(low - spare, resolution_m), key_of(high + spare, resolution_m));
}

std::optional<CellKey> flyable_near(const Vec3& start, const CellSet& clear, const Reachable& r) {
  const double edge = r.options.resolution_m;
  std::optional<CellKey> best;
  double best_distance = kStartSearchM;
  const CellKey low = key_of(start - Vec3::Constant(kStartSearchM), edge),
                high = key_of(start + Vec3::Constant(kStartSearchM), edge);
  for (std::int32_t z = low.z; z <= high.z; ++z)
    for (std::int32_t y = low.y; y <= high.y; ++y)
      for (std::int32_t x = low.x; x <= high.x; ++x) {
        const CellKey k{x, y, z};
        if (!clear.contains(k)) continue;
        const Vec3 center = center_of(k, edge);
        const double distance = (center - start).norm();
        if (distance >= best_distance) continue;
        // Sampling every half cell suffices: a wall in between is at least one cell of rock thick.
        const int points = 1 + static_cast<int>(2 * distance / edge);
        bool open = true;
        for (int i = 0; i <= points && open; ++i)
          open = r.free.contains(key_of(start + (center - start) * i / points, edge));
        if (!open) continue;
        best = k;
        best_distance = distance;
      }
  return best;
}

/// What `find` returns; more blocks than a set can hold are an error of the mesh.
template <class Find>
Reachable within_memory(const std::string& name, double resolution_m, const Find& find) {
  try {
    return find();
  } catch (const std::length_error&) {
    refuse_size(name, resolution_m);
  }
}

/// All sets except `reachable`, which includes cells that are only seen.
Reachable find_flyable(const cave::TriangleMesh& mesh, const Vec3& start, const ReachableOptions& options,
                       const std::string& name) {
  const double edge = options.resolution_m;
  CellSet rock = empty_set_around(mesh, edge, name);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) insert_touched(rock, triangle(mesh, i), edge);

  const std::string where = "start " + place_text(start);
  const CellKey seed = key_of(start, edge);
  if (!rock.has_place(rock.block_of(seed))) throw InputError(name, where, "outside the mesh");
  if (rock.contains(seed)) throw InputError(name, where, "in rock");

  Reachable r;
  r.options = options;
  std::optional<CellSet> free = flood_between(rock, seed);
  if (!free) {
    const Vec3 opening = center_of(find_opening(rock, seed), edge);
    throw InputError(name, where,
                     "free space leads outside the mesh near " + place_text(opening) +
                         cave::hole_text(cave::nearest_loop(mesh, cave::boundary_loops(mesh), opening)));
  }
  r.free = std::move(*free);

  CellSet clear = r.free;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    remove_near(clear, triangle(mesh, i), edge, options.clearance_m);
  const auto first = flyable_near(start, clear, r);
  if (!first)
    throw InputError(name, where,
                     "no place with " + number_text(options.clearance_m) +
                         " m to rock in a straight line within " + number_text(kStartSearchM) + " m");
  r.flyable = flood(clear, *first);
  r.free_cells = r.free.size();
  r.flyable_cells = r.flyable.size();
  return r;
}

}  // namespace

Reachable find_reachable(const cave::TriangleMesh& mesh, const Vec3& start, const ReachableOptions& options,
                         const std::string& name) {
  return within_memory(name, options.resolution_m, [&] {
    Reachable r = find_flyable(mesh, start, options, name);
    r.reachable = seen_from(r.flyable, r.free, options.sight_m / options.resolution_m);
    r.reachable_cells = r.reachable.size();
    return r;
  });
}

void check_reachable(const cave::TriangleMesh& mesh, const Vec3& start, const ReachableOptions& options,
                     const std::string& name) {
  within_memory(name, options.resolution_m, [&] { return find_flyable(mesh, start, options, name); });
}

}  // namespace karst::evaluation
