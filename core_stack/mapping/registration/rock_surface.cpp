#include "core_stack/mapping/registration/rock_surface.h"

#include <cmath>

#include "core_stack/mapping/obstacles/plane_normal.h"

namespace karst::core {
namespace {

/// Wide enough for some fifteen cells of rock, and narrower than the bends of a wall.
constexpr double kNeighbourCells = 2.5;
constexpr std::size_t kMaxPoints = 8000;  // evenly picked for the residual

}  // namespace

MapPiece on_rock_surface(const MapPiece& piece) {
  MapPiece smooth = piece;
  for (Vec3f& p : smooth.surface) {
    const auto near = piece.tree->within(p.cast<double>(), kNeighbourCells * piece.resolution_m);
    const Vec3f normal = plane_normal(piece.surface, near, p);
    Vec3f sum = Vec3f::Zero();
    for (const std::uint32_t i : near) sum += piece.surface[i] - p;
    p += normal * (normal.dot(sum) / static_cast<float>(near.size()));
  }
  smooth.tree = std::make_shared<PointTree>(smooth.surface);
  return smooth;
}

double surface_residual_m(const MapPiece& target, const MapPiece& source, const Pose& T_target_source,
                          double near_m) {
  double squares_m2 = 0;
  std::size_t near = 0;
  const std::size_t stride = source.surface.size() / kMaxPoints + 1;
  for (std::size_t i = 0; i < source.surface.size(); i += stride) {
    const Vec3 p = T_target_source * source.surface[i].cast<double>();
    const auto nearest = target.tree->nearest(p);
    if (!nearest || nearest->distance_m > near_m) continue;
    const double d =
        target.normals[nearest->index].cast<double>().dot(p - target.surface[nearest->index].cast<double>());
    squares_m2 += d * d;
    ++near;
  }
  return near == 0 ? near_m : std::sqrt(squares_m2 / static_cast<double>(near));
}

}  // namespace karst::core
