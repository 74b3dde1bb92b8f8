// Parts of meshes, what they enclose, and which surface was guessed, on shapes with a closed form.
#include "sdk/cave_from_cloud/mesh_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "plugins/simulator/cave/mesh_volume.h"
#include "sdk/cave_from_cloud/guessed_surface.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::from_cloud {
namespace {

using cave::TriangleMesh;
using core::Vec3;
using core::Vec3f;

/// A cube whose triangles share its eight corners and face outwards.
TriangleMesh cube(const Vec3f& low, float edge_m) {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.push_back(low + edge_m * Vec3f(static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1),
                                              static_cast<float>(i >> 2)));
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

/// A level square of `side` x `side` cells, its corners shared.
TriangleMesh square(std::uint32_t side, float cell_m) {
  TriangleMesh m;
  for (std::uint32_t y = 0; y <= side; ++y)
    for (std::uint32_t x = 0; x <= side; ++x)
      m.vertices.emplace_back(cell_m * static_cast<float>(x), cell_m * static_cast<float>(y), 0.0f);
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x, b = a + side + 1;
      m.triangles.push_back({a, a + 1, b});
      m.triangles.push_back({a + 1, b + 1, b});
    }
  return m;
}

TEST(MeshParts, AreWhatSharesNoVertex) {
  TriangleMesh two = cube({0, 0, 0}, 2);
  test::append(two, cube({5, 0, 0}, 1));
  const MeshParts parts = parts_of(two);
  ASSERT_EQ(parts.count, 2u);
  const TriangleMesh first = part_of(two, parts, 0), second = part_of(two, parts, 1);
  EXPECT_EQ(first.triangles.size(), 12u);
  EXPECT_EQ(first.vertices.size(), 8u);
  EXPECT_NEAR(cave::enclosed_volume_m3(first), -8, 1e-6) << "positive where normals point inwards";
  EXPECT_NEAR(cave::enclosed_volume_m3(second), -1, 1e-6);
  EXPECT_EQ(parts_of({}).count, 0u);
}

TEST(MeshParts, WindAroundWhatTheyEnclose) {
  TriangleMesh nested = cube({0, 0, 0}, 3);
  test::append(nested, cube({1, 1, 1}, 1));
  const MeshParts parts = parts_of(nested);
  const auto around = [&](const Vec3& p) { return winding_numbers(nested, parts, p); };
  const std::vector<double> both = around({1.5, 1.4, 1.6}), outer = around({0.4, 0.5, 2.3}),
                            none = around({-1, 0.2, 5});
  EXPECT_NEAR(both[0], 1, 1e-9);
  EXPECT_NEAR(both[1], 1, 1e-9);
  EXPECT_NEAR(outer[0], 1, 1e-9);
  EXPECT_NEAR(outer[1], 0, 1e-9);
  EXPECT_NEAR(none[0], 0, 1e-9);
  EXPECT_NEAR(none[1], 0, 1e-9);
}

TEST(MeshParts, OfACubeWithoutOneFaceWindFiveSixthsAroundItsMiddle) {
  TriangleMesh open = cube({0, 0, 0}, 2);
  open.triangles.resize(10);
  EXPECT_NEAR(winding_numbers(open, parts_of(open), {1, 1, 1})[0], 5.0 / 6, 1e-9);
}

TEST(GuessedSurface, IsWhatLiesFarFromAllPoints) {
  // A square of 10 m, measured but for two discs, of 2 m around (3, 3) and of 1 m around (8, 7).
  const TriangleMesh mesh = square(100, 0.1f);
  const Vec3 first(3, 3, 0), second(8, 7, 0);
  std::vector<Vec3f> points;
  for (int x = 0; x <= 200; ++x)
    for (int y = 0; y <= 200; ++y) {
      const Vec3 p(0.05 * x, 0.05 * y, 0.02);
      if ((p - first).norm() > 2 && (p - second).norm() > 1) points.push_back(p.cast<float>());
    }
  const core::PointTree measured(points);
  const GuessedSurface guessed = guessed_surface(mesh, guessed_triangles(mesh, measured, 0.25));
  EXPECT_NEAR(guessed.whole_m2, 100, 1e-3);
  ASSERT_EQ(guessed.patches.size(), 2u);
  const auto disc_m2 = [](double r) { return std::numbers::pi * r * r; };
  // Cells of 0.1 m at the rim belong to it in part.
  EXPECT_NEAR(guessed.patches[0].area_m2, disc_m2(1.75), 0.12 * 2 * std::numbers::pi * 1.75);
  EXPECT_NEAR(guessed.patches[1].area_m2, disc_m2(0.75), 0.12 * 2 * std::numbers::pi * 0.75);
  EXPECT_NEAR(guessed.area_m2, guessed.patches[0].area_m2 + guessed.patches[1].area_m2, 1e-9);
  EXPECT_LT((guessed.patches[0].centre - first).norm(), 0.05);
  EXPECT_LT((guessed.patches[1].centre - second).norm(), 0.05);
  EXPECT_NEAR(guessed.patches[0].diameter_m, 3.5, 0.25);
}

TEST(GuessedSurface, OfAMeasuredMeshIsNone) {
  const TriangleMesh mesh = square(10, 0.5f);
  const core::PointTree measured(mesh.vertices);
  const GuessedSurface guessed = guessed_surface(mesh, guessed_triangles(mesh, measured, 0.01));
  EXPECT_EQ(guessed.area_m2, 0);
  EXPECT_TRUE(guessed.patches.empty());
}

}  // namespace
}  // namespace karst::from_cloud
