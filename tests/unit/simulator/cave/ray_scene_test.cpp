#include "plugins/simulator/cave/ray_scene.h"

#include <gtest/gtest.h>
// RapidCheck's header needs GoogleTest's before it.
#include <rapidcheck/gtest.h>

#include <cstring>
#include <optional>

#include "plugins/simulator/cave/closest_point.h"
#include "plugins/simulator/cave/ray_triangle.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using cave::Hit;
using cave::Ray;
using cave::RayScene;

/// Moller and Trumbore, 1997, in doubles.
std::optional<double> intersect(const Vec3& o, const Vec3& d, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 e1 = b - a, e2 = c - a, p = d.cross(e2);
  const double det = e1.dot(p);
  if (std::abs(det) < 1e-14) return std::nullopt;
  const double u = (o - a).dot(p) / det;
  const Vec3 q = (o - a).cross(e1);
  const double v = d.dot(q) / det, t = e2.dot(q) / det;
  if (u < 0 || v < 0 || u + v > 1 || t < 0) return std::nullopt;
  return t;
}

double brute_force_range(const cave::TriangleMesh& m, const Vec3& o, const Vec3& d) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& t : m.triangles) {
    const auto v = [&](int k) -> Vec3 { return m.vertices[t[static_cast<std::size_t>(k)]].cast<double>(); };
    if (const auto hit = intersect(o, d, v(0), v(1), v(2))) best = std::min(best, *hit);
  }
  return best;
}

std::vector<Ray> rays_in(double length_m, int n, std::uint64_t seed) {
  core::Random random(seed);
  std::vector<Ray> rays;
  for (int i = 0; i < n; ++i) {
    const Vec3 o(random.uniform(1, length_m - 1), random.uniform(-1, 1), random.uniform(-1, 1));
    rays.push_back({o.cast<float>(), random_unit(random).cast<float>()});
  }
  return rays;
}

TEST(RayScene, AgreesWithBruteForceInATunnel) {
  const auto mesh = tunnel_mesh(30, 3, 5);
  const RayScene scene(mesh);
  const auto rays = rays_in(30, 500, 9);
  std::vector<Hit> hits(rays.size());
  scene.cast(rays, 100, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3 d = rays[i].direction.cast<double>();
    const double expected = brute_force_range(mesh, rays[i].origin.cast<double>(), d);
    ASSERT_TRUE(hits[i].any());
    // Floats at 30 m resolve 2 um; a grazing hit magnifies that.
    EXPECT_NEAR(hits[i].range_m, expected, 1e-3);
    EXPECT_NEAR(hits[i].normal.norm(), 1, 1e-5);
    EXPECT_LT(hits[i].normal.dot(rays[i].direction), 0) << "normals face where the ray came from";
  }
}

TEST(RayScene, PacketsEqualSingleRaysBitForBit) {
  const RayScene scene(tunnel_mesh(40, 3, 6));
  for (const std::size_t n : {1u, 7u, 8u, 9u, 4003u}) {
    const auto rays = rays_in(40, static_cast<int>(n), n);
    std::vector<Hit> hits(n);
    scene.cast(rays, 20, hits);
    for (std::size_t i = 0; i < n; ++i) {
      const Hit one = scene.cast(rays[i], 20);
      ASSERT_EQ(one.triangle, hits[i].triangle);
      ASSERT_EQ(std::memcmp(&one.range_m, &hits[i].range_m, sizeof one.range_m), 0);
      ASSERT_EQ(one.normal, hits[i].normal);
    }
  }
}

/// Rays at corners and edges, also far from the origin, where single precision is coarse: the test that saves
/// most triangles from double precision must not lose one.
TEST(RayScene, FindsWhatAllTrianglesInDoublePrecisionGiveToTheLastBit) {
  core::Random random(12);
  for (const float away_m : {0.0f, 300.0f, 7000.0f}) {
    auto mesh = tunnel_mesh(20, 3, 6);
    for (Vec3f& v : mesh.vertices) v += Vec3f(away_m, -2 * away_m, away_m / 3);
    const RayScene scene(mesh);
    std::vector<Ray> rays;
    for (const auto& t : mesh.triangles) {
      const Vec3f from = Vec3f(away_m, -2 * away_m, away_m / 3) +
                         Vec3f(static_cast<float>(random.uniform(5, 15)), 0.1f, -0.2f);
      const auto part = static_cast<float>(std::round(random.uniform(0, 4))) / 4;
      const Vec3f to = mesh.vertices[t[0]] + part * (mesh.vertices[t[1]] - mesh.vertices[t[0]]);
      rays.push_back({from, (to - from).normalized()});
    }
    std::vector<Hit> hits(rays.size());
    scene.cast(rays, 100, hits);
    int hit = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      double best = 100;
      std::optional<std::uint32_t> first;
      for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
        const auto corner = [&](std::size_t c) -> Vec3 {
          return mesh.vertices[mesh.triangles[k][c]].cast<double>();
        };
        const auto range = cave::ray_triangle_range(
            rays[i].origin.cast<double>(), rays[i].direction.cast<double>(), corner(0), corner(1), corner(2));
        if (!range || *range > best || (*range == best && first)) continue;
        best = *range;
        first = k;
      }
      ASSERT_EQ(hits[i].any(), first.has_value()) << "ray " << i;
      if (!first) continue;
      ++hit;
      ASSERT_EQ(hits[i].triangle, *first) << "ray " << i;
      ASSERT_EQ(hits[i].range_m, static_cast<float>(best)) << "ray " << i;
    }
    EXPECT_GT(hit, 300);
  }
}

/// Rays at the very corners and along the edges of the triangles, where rounding decides who is met.
TEST(RayScene, NoRaySlipsBetweenTwoTriangles) {
  const auto mesh = tunnel_mesh(20, 3, 8);
  const RayScene scene(mesh);
  core::Random random(4);
  int cast = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>();
    const Vec3f from(static_cast<float>(random.uniform(5, 15)), 0.1f, -0.2f);
    for (const double fraction : {0.0, 0.25, 0.5}) {
      const Vec3f to = (a + fraction * (b - a)).cast<float>();
      if (to.x() < 1 || to.x() > 19) continue;  // the tunnel's ends are open
      ASSERT_TRUE(scene.cast({from, (to - from).normalized()}, 100).any()) << to.transpose();
      ++cast;
    }
  }
  EXPECT_GT(cast, 1000);
}

/// The neighbour across an edge computes the same volume with the other sign.
RC_GTEST_PROP(RayTriangle, OneOfTwoNeighboursIsMetAndBothOnlyOnTheirEdge, (std::uint32_t seed)) {
  core::Random r(seed);
  const auto corner = [&](double x, double y) { return Vec3(x, y, r.uniform(-0.1, 0.1)); };
  const Vec3 a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
  const Vec3 from(r.uniform(0.1, 0.9), r.uniform(0.1, 0.9), 5);
  const double along = r.uniform(0.2, 0.8);
  const Vec3 aim = a + along * (c - a) + r.uniform(-1e-16, 1e-16) * Vec3::UnitX();  // at the shared edge
  const Vec3 direction = (aim - from).normalized();
  const auto first = cave::ray_triangle_range(from, direction, a, b, c),
             second = cave::ray_triangle_range(from, direction, a, c, d);
  RC_ASSERT(first || second);
  if (first && second) RC_ASSERT(std::abs(*first - *second) < 1e-12);
  RC_ASSERT(std::abs((first ? *first : *second) - (aim - from).norm()) < 1e-9);
}

RC_GTEST_PROP(RayTriangle, AgreesWithMollerAndTrumbore, (std::uint32_t seed)) {
  core::Random r(seed);
  const auto point = [&] { return Vec3(r.uniform(-2, 2), r.uniform(-2, 2), r.uniform(-2, 2)); };
  const Vec3 o = point(), a = point(), b = point(), c = point(), d = random_unit(r);
  const auto expected = intersect(o, d, a, b, c), range = cave::ray_triangle_range(o, d, a, b, c);
  RC_ASSERT(range.has_value() == expected.has_value());
  if (range)
    RC_ASSERT(std::abs(*range - *expected) < 1e-9 * (1 + *expected) / std::abs(d.dot((b - a).cross(c - a))));
}

TEST(RayScene, FindsNothingBeyondTheRangeAskedFor) {
  const RayScene scene(box_mesh({-5, -5, -5}, {5, 5, 5}));
  EXPECT_FALSE(scene.cast({Vec3f::Zero(), Vec3f::UnitX()}, 4.9f).any());
  EXPECT_TRUE(scene.cast({Vec3f::Zero(), Vec3f::UnitX()}, 5.1f).any());
  EXPECT_TRUE(std::isinf(scene.ray_cast(Vec3::Zero(), {1, 0, 0}, 4.9)));
  EXPECT_NEAR(scene.ray_cast({1, 1, 1}, {0, 0, -3}, 100), 6, 1e-6);
}

TEST(RayScene, CountsTheSurfacesARayPasses) {
  auto mesh = box_mesh({-5, -5, -5}, {5, 5, 5});
  append(mesh, box_mesh({1, -1, -1}, {2, 1, 1}));
  const RayScene scene(mesh);
  EXPECT_EQ(scene.crossings({Vec3f(0, 0.1f, 0.2f), Vec3f::UnitX()}), 3);
  EXPECT_EQ(scene.crossings({Vec3f(0, 0.1f, 0.2f), -Vec3f::UnitX()}), 1);
  EXPECT_EQ(scene.crossings({Vec3f(9, 0.1f, 0.2f), Vec3f::UnitX()}), 0);
}

/// Least distance over a triangle by golden-section search in two barycentric coordinates: slow, but shares
/// nothing with the closed form. Distance to a triangle is convex in them.
double searched_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto minimum = [](double lo, double hi, const auto& f) {
    for (int i = 0; i < 60; ++i) {
      const double m1 = lo + (hi - lo) * 0.381966011250105, m2 = lo + (hi - lo) * 0.618033988749895;
      if (f(m1) < f(m2)) {
        hi = m2;
      } else {
        lo = m1;
      }
    }
    return f((lo + hi) / 2);
  };
  return minimum(0, 1, [&](double u) {
    return minimum(0, 1 - u, [&](double v) { return (a + u * (b - a) + v * (c - a) - p).norm(); });
  });
}

RC_GTEST_PROP(ClosestPoint, IsNoFartherThanAnyOtherOfTheTriangle, (std::uint32_t seed)) {
  core::Random r(seed);
  const auto point = [&] { return Vec3(r.uniform(-2, 2), r.uniform(-2, 2), r.uniform(-2, 2)); };
  const Vec3 a = point(), b = point(), c = point(), p = point();
  const double d = (cave::closest_on_triangle(p, a, b, c) - p).norm();
  RC_ASSERT(std::abs(d - searched_distance(p, a, b, c)) < 1e-6);
}

TEST(RayScene, NearestRockIsTheNearestOfAllTriangles) {
  const auto mesh = tunnel_mesh(20, 3, 7);
  const RayScene scene(mesh);
  core::Random r(3);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p(r.uniform(-2, 22), r.uniform(-5, 5), r.uniform(-5, 5));
    double expected = 100;
    for (const auto& t : mesh.triangles) {
      const auto v = [&](std::size_t k) -> Vec3 { return mesh.vertices[t[k]].cast<double>(); };
      expected = std::min(expected, (cave::closest_on_triangle(p, v(0), v(1), v(2)) - p).norm());
    }
    const cave::Nearest n = scene.nearest(p, 100);
    ASSERT_TRUE(n.found);
    EXPECT_NEAR(n.distance_m, expected, 1e-9);
    EXPECT_NEAR((n.point - p).norm(), expected, 1e-9);
  }
}

TEST(RayScene, NearestSaysWhenThereIsNothingNear) {
  const RayScene scene(box_mesh({-5, -5, -5}, {5, 5, 5}));
  const cave::Nearest n = scene.nearest(Vec3::Zero(), 4);
  EXPECT_FALSE(n.found);
  EXPECT_EQ(n.distance_m, 4);
  EXPECT_NEAR(scene.distance_to_rock({4, 1, 2}, 10), 1, 1e-9);
}

}  // namespace
}  // namespace karst::test
