#include "core_stack/mapping/registration/map_piece.h"

#include <algorithm>
#include <stdexcept>

#include "core_stack/mapping/obstacles/plane_normal.h"
#include "core_stack/mapping/obstacles/thinned_out.h"

namespace karst::core {
namespace {

constexpr double kNormalRadiusCells = 4;

/// Whether more of the cells two and three steps away are free in this direction than in the opposite one.
bool points_to_free(const VoxelMap& map, const Vec3f& p, const Vec3f& normal) {
  int free = 0;
  for (const float steps : {-3.0f, -2.0f, 2.0f, 3.0f}) {
    const Vec3 at = (p + steps * static_cast<float>(map.resolution_m()) * normal).cast<double>();
    if (map.at(at) == Cell::free) free += steps > 0 ? 1 : -1;
  }
  return free >= 0;
}

void complete(MapPiece& piece) {
  if (piece.surface.empty()) throw std::invalid_argument("the map holds no rock");
  piece.tree = std::make_shared<PointTree>(piece.surface);
  piece.normals.reserve(piece.surface.size());
  for (const Vec3f& p : piece.surface) {
    Vec3f n = plane_normal(piece.tree->points(),
                           piece.tree->within(p.cast<double>(), kNormalRadiusCells * piece.resolution_m), p);
    if (piece.cells && !points_to_free(*piece.cells, p, n)) n = -n;
    piece.normals.push_back(n);
  }
}

}  // namespace

MapPiece piece_of(std::shared_ptr<const VoxelMap> map) {
  MapPiece piece;
  piece.resolution_m = map->resolution_m();
  map->for_each_known([&](const CellKey& k, Cell c, float) {
    if (c == Cell::occupied) piece.surface.push_back(map->center_of(k).cast<float>());
  });
  piece.cells = std::move(map);
  complete(piece);
  return piece;
}

MapPiece piece_of(const std::vector<Vec3f>& cloud, double resolution_m) {
  MapPiece piece;
  piece.resolution_m = resolution_m;
  piece.surface = thinned_out(cloud, resolution_m);
  complete(piece);
  return piece;
}

}  // namespace karst::core
