// Points on the rock rather than in the middle of its cells.
#include "core_stack/mapping/registration/rock_surface.h"

#include <gtest/gtest.h>

#include <cmath>

namespace karst::core {
namespace {

constexpr double kCell_m = 0.2;

/// Rock from one surface to two cells beyond it, free space on the other side: depth(p) is negative there.
template <class Depth>
MapPiece piece(const Depth& depth) {
  auto map = std::make_shared<VoxelMap>(MapOptions{});
  for (int z = -20; z < 20; ++z)
    for (int y = -20; y < 20; ++y)
      for (int x = -20; x < 20; ++x)
        if (const double d = depth(map->center_of({x, y, z})); std::abs(d) < 0.6)
          if (d < -kCell_m / 2 || d < kCell_m / 2) map->assign({x, y, z}, 1, d < -kCell_m / 2 ? -1.0f : 1.0f);
  return piece_of(map);
}

double rms(const MapPiece& piece, const auto& depth) {
  double squares = 0;
  std::size_t count = 0;
  for (const Vec3f& p : piece.surface) {
    if (p.cwiseAbs().maxCoeff() > 3) continue;  // the edge of the drawn part has neighbours on one side only
    squares += std::pow(depth(p.cast<double>()), 2);
    ++count;
  }
  return std::sqrt(squares / static_cast<double>(count));
}

TEST(RockSurface, LiesOnAPlaneThatIsAskewToTheCells) {
  const Vec3 normal = Vec3(0.3, 0.5, 0.8).normalized();
  const auto depth = [&](const Vec3& p) { return normal.dot(p) - 0.07; };
  const MapPiece cells = piece(depth);
  EXPECT_GT(rms(cells, depth), 0.05);
  EXPECT_LT(rms(on_rock_surface(cells), depth), 0.2 * rms(cells, depth));
}

TEST(RockSurface, LiesOnAWallThatBends) {
  const auto depth = [](const Vec3& p) { return (p - Vec3(0.03, 0.02, 0)).norm() - 2.5; };
  const MapPiece cells = piece(depth);
  EXPECT_LT(rms(on_rock_surface(cells), depth), 0.5 * rms(cells, depth));
}

TEST(RockSurface, TheResidualIsTheDistanceOfThePlanes) {
  const MapPiece plane =
      on_rock_surface(piece([](const Vec3& p) { return Vec3(0.3, 0.5, 0.8).normalized().dot(p); }));
  const Vec3 normal = Vec3(0.3, 0.5, 0.8).normalized();
  for (const double off_m : {0.0, 0.05, 0.12}) {
    const Pose T{off_m * normal, Quat::Identity()};
    EXPECT_NEAR(surface_residual_m(plane, plane, T, 0.35), off_m, 0.015) << off_m;
  }
  EXPECT_EQ(surface_residual_m(plane, plane, {Vec3(500, 0, 0), Quat::Identity()}, 0.35), 0.35);
}

}  // namespace
}  // namespace karst::core
