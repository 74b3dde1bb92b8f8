#include "plugins/simulator/cave/cap_holes.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "plugins/simulator/cave/preflight.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using cave::boundary_loops;
using cave::BoundaryLoop;
using cave::cap_holes;
using cave::Capped;
using cave::LeftOpen;
using cave::RayScene;
using cave::TriangleMesh;

/// Enclosed volume by the divergence theorem; signed by the winding, which must be the same everywhere.
double enclosed_m3(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += mesh.vertices[t[0]].cast<double>().dot(
        mesh.vertices[t[1]].cast<double>().cross(mesh.vertices[t[2]].cast<double>()));
  return std::abs(sum) / 6;
}

/// Whether every edge is run along once each way, by position.
bool is_closed_and_oriented(const TriangleMesh& mesh) {
  using Place = std::array<float, 3>;
  std::map<std::pair<Place, Place>, int> runs;
  const auto place = [&](std::uint32_t i) {
    const Vec3f& v = mesh.vertices[i];
    return Place{v.x(), v.y(), v.z()};
  };
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++runs[{place(t[i]), place(t[(i + 1) % 3])}];
  return std::all_of(runs.begin(), runs.end(), [&](const auto& run) {
    const auto back = runs.find({run.first.second, run.first.first});
    return run.second == 1 && back != runs.end() && back->second == 1;
  });
}

/// A smooth tube along x, of n corners, with or without its ends: bits 1 and 2. One winding all round.
TriangleMesh tube(double length_m, double radius_m, std::uint32_t corners, unsigned ends) {
  TriangleMesh m;
  const auto rings = static_cast<std::uint32_t>(length_m) + 1;
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t k = 0; k < corners; ++k) {
      const double a = 2 * std::numbers::pi * k / corners;
      m.vertices.push_back(Vec3(i, radius_m * std::cos(a), radius_m * std::sin(a)).cast<float>());
    }
  for (std::uint32_t i = 0; i + 1 < rings; ++i)
    for (std::uint32_t k = 0; k < corners; ++k) {
      const std::uint32_t a = i * corners + k, b = i * corners + (k + 1) % corners;
      m.triangles.push_back({a, b, b + corners});
      m.triangles.push_back({a, b + corners, a + corners});
    }
  for (std::uint32_t k = 1; k + 1 < corners; ++k) {
    const std::uint32_t last = (rings - 1) * corners;
    if (ends & 1) m.triangles.push_back({0, k + 1, k});
    if (ends & 2) m.triangles.push_back({last, last + k, last + k + 1});
  }
  return m;
}

double polygon_m2(double radius_m, int corners) {
  return corners * radius_m * radius_m * std::sin(2 * std::numbers::pi / corners) / 2;
}

TEST(BoundaryLoops, OfAClosedMeshThereAreNone) {
  EXPECT_TRUE(boundary_loops(tunnel_mesh(10, 2, 1)).empty());
  EXPECT_TRUE(boundary_loops(box_mesh({0, 0, 0}, {1, 2, 3})).empty()) << "corners count by their position";
  EXPECT_TRUE(boundary_loops({}).empty());
}

TEST(BoundaryLoops, OfAnOpenTubeHaveAreaAndDiameterOfItsCrossSection) {
  const auto loops = boundary_loops(tube(10, 2, 24, 0b01));
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].vertices.size(), 24u);
  EXPECT_NEAR(loops[0].area_m2, polygon_m2(2, 24), 1e-5);
  EXPECT_NEAR(loops[0].diameter_m, 4, 1e-5);
  EXPECT_LT((loops[0].centre - Vec3(10, 0, 0)).norm(), 1e-5);
  EXPECT_NEAR(std::abs(loops[0].normal.x()), 1, 1e-6);
}

TEST(BoundaryLoops, OfAHoleInAWallAreTheHolesAlone) {
  TriangleMesh m = tube(20, 3, 24, 0b11);
  const std::size_t first = 2 * (24 * 5 + 4);  // the two triangles of a facet of the wall
  m.triangles.erase(m.triangles.begin() + first, m.triangles.begin() + first + 2);
  const auto loops = boundary_loops(m);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].vertices.size(), 4u);
  EXPECT_NEAR(loops[0].area_m2, 1 * 2 * 3 * std::sin(std::numbers::pi / 24), 1e-5);
}

TEST(BoundaryLoops, HolesThatTouchAtACornerAreTwo) {
  // A floor of 4 x 4 squares without two that share a corner, seen as a mesh on its own: three loops.
  TriangleMesh m;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      if (!(x == 1 && y == 1) && !(x == 2 && y == 2))
        add_quad(m, Vec3(x, y, 0), Vec3(x + 1, y, 0), Vec3(x + 1, y + 1, 0), Vec3(x, y + 1, 0));
  const auto loops = boundary_loops(m);
  ASSERT_EQ(loops.size(), 3u);
  EXPECT_NEAR(loops[0].area_m2, 16, 1e-6) << "the largest first: the floor's own border";
  EXPECT_NEAR(loops[1].area_m2, 1, 1e-6);
  EXPECT_NEAR(loops[2].area_m2, 1, 1e-6);
  EXPECT_EQ(cave::nearest_loop(m, loops, {-0.1, -0.1, 0}), &loops[0]);
  const BoundaryLoop* near = cave::nearest_loop(m, loops, {0.9, 0.9, 1});
  ASSERT_NE(near, nullptr);
  EXPECT_LT((near->centre - Vec3(1.5, 1.5, 0)).norm(), 1e-6);
  EXPECT_EQ(cave::nearest_loop(m, {}, Vec3::Zero()), nullptr);
}

TEST(BoundaryLoops, TheTextNamesSizePlaceAndTheCommand) {
  const auto loops = boundary_loops(tube(10, 2, 24, 0b01));
  const std::string text = cave::hole_text(&loops[0]);
  for (const char* part : {"loop of 24", "4 m across", "12 m²", "around 10.0 ", "--cap"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  EXPECT_NE(cave::hole_text(nullptr).find("no edge is open"), std::string::npos);
}

TEST(CapHoles, AnOpenTubeIsClosedAsItWas) {
  const Capped c = cap_holes(RayScene(tube(10, 2, 24, 0b00)), 20);
  ASSERT_EQ(c.loops.size(), 2u);
  for (const cave::CapOfLoop& l : c.loops) EXPECT_EQ(l.left, LeftOpen::no);
  EXPECT_TRUE(is_closed_and_oriented(c.mesh));
  EXPECT_NEAR(enclosed_m3(c.mesh), enclosed_m3(tube(10, 2, 24, 0b11)), 1e-4);
  EXPECT_EQ(c.mesh.vertices.size(), tube(10, 2, 24, 0b00).vertices.size()) << "ears need no new vertex";
  EXPECT_EQ(error_of([&] { cave::check_start(make_cave(c.mesh, {5, 0, 0}), 0.3); }), "");
}

TEST(CapHoles, WiderHolesThanTheLimitStayOpen) {
  const Capped c = cap_holes(RayScene(tube(10, 2, 24, 0b00)), 3.9);
  ASSERT_EQ(c.loops.size(), 2u);
  for (const cave::CapOfLoop& l : c.loops) EXPECT_EQ(l.left, LeftOpen::too_large);
  EXPECT_EQ(c.mesh.triangles.size(), tube(10, 2, 24, 0b00).triangles.size());
}

TEST(CapHoles, SeamsOfTilesStayOpenAndTheEntranceIsClosed) {
  // Two tiles that overlap by half a metre: each ends in a ring within the other. The far end is open.
  TriangleMesh m = tube(10, 2, 24, 0b01);
  TriangleMesh second = tube(10, 2.02, 24, 0b00);
  for (Vec3f& v : second.vertices) v.x() += 9.5f;
  append(m, second);
  const Capped c = cap_holes(RayScene(m), 20);
  ASSERT_EQ(c.loops.size(), 3u);
  int seams = 0;
  for (const cave::CapOfLoop& l : c.loops) {
    const bool far_end = l.loop.centre.x() > 15;
    EXPECT_EQ(l.left, far_end ? LeftOpen::no : LeftOpen::seam) << l.loop.centre.transpose();
    seams += l.left == LeftOpen::seam;
  }
  EXPECT_EQ(seams, 2);
  EXPECT_EQ(RayScene(c.mesh).crossings({Vec3f(5, 0.1f, 0.2f), Vec3f::UnitX()}), 1) << "no wall at the seam";
}

TEST(CapHoles, ASlitIsNoHole) {
  // The wall at -x is two quads, whose corners lie in the middle of the floor's and the roof's edge.
  TriangleMesh m = box_mesh({0, 0, 0}, {2, 2, 2}, 0b111110);
  add_quad(m, {0, 0, 0}, {0, 1, 0}, {0, 1, 2}, {0, 0, 2});
  add_quad(m, {0, 1, 0}, {0, 2, 0}, {0, 2, 2}, {0, 1, 2});
  const Capped c = cap_holes(RayScene(m), 20);
  ASSERT_EQ(c.loops.size(), 2u);
  for (const cave::CapOfLoop& l : c.loops) {
    EXPECT_EQ(l.left, LeftOpen::slit);
    EXPECT_EQ(l.loop.vertices.size(), 3u);
  }
  EXPECT_EQ(c.mesh.triangles.size(), m.triangles.size());
  EXPECT_EQ(c.mesh.vertices.size(), m.vertices.size());
}

TEST(CapHoles, AConcaveHoleIsCoveredWithinItsBorder) {
  // A floor with a hole like the letter U; a fan round its middle would cover the tongue of rock, too.
  TriangleMesh m;
  const auto is_hole = [](int x, int y) {
    return x >= 1 && x <= 5 && y >= 1 && y <= 5 && !(x == 3 && y >= 2);
  };
  int squares = 0;
  for (int x = 0; x < 7; ++x)
    for (int y = 0; y < 7; ++y) {
      if (is_hole(x, y)) {
        ++squares;
        continue;
      }
      add_quad(m, Vec3(x, y, 0), Vec3(x + 1, y, 0), Vec3(x + 1, y + 1, 0), Vec3(x, y + 1, 0));
    }
  const auto loops = boundary_loops(m);
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_NEAR(loops[1].area_m2, squares, 1e-5);
  double area_m2 = 0;
  for (const auto& t : cave::cap_of(loops[1], m)) {
    const Vec3 a = m.vertices[t[0]].cast<double>(), b = m.vertices[t[1]].cast<double>(),
               c = m.vertices[t[2]].cast<double>();
    area_m2 += (b - a).cross(c - a).norm() / 2;
    const Vec3 middle = (a + b + c) / 3;
    EXPECT_TRUE(is_hole(static_cast<int>(std::floor(middle.x())), static_cast<int>(std::floor(middle.y()))) ||
                (b - a).cross(c - a).norm() < 1e-6)
        << middle.transpose();
  }
  EXPECT_NEAR(area_m2, squares, 1e-4) << "no part is covered twice";
}

TEST(CapHoles, ALoopThatCrossesItselfGetsAFan) {
  TriangleMesh m;
  for (const Vec3& v : {Vec3(0, 0, 0), Vec3(2, 2, 0), Vec3(2, 0, 0), Vec3(0, 3, 0)})
    m.vertices.push_back(v.cast<float>());
  BoundaryLoop bow;
  bow.vertices = {0, 1, 2, 3};
  bow.centre = Vec3(1, 1, 0);
  const auto cap = cave::cap_of(bow, m);
  EXPECT_EQ(cap.size(), 4u);
  EXPECT_EQ(m.vertices.size(), 5u);
  std::set<std::pair<std::uint32_t, std::uint32_t>> runs;
  for (const auto& t : cap)
    for (std::size_t i = 0; i < 3; ++i) runs.insert({t[i], t[(i + 1) % 3]});
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_TRUE(runs.count({i, (i + 1) % 4})) << "every edge is closed";
}

/// A box of n squares of 1 m along each edge, away from the origin; its wall at -x lacks some squares (z, y).
TriangleMesh box_with_holes(int n, const std::set<std::pair<int, int>>& without) {
  const double s = n;
  const Vec3 corner(10, 20, 30), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  TriangleMesh m;
  const auto wall = [&](const Vec3& from, const Vec3& u, const Vec3& v, bool with_holes) {
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k)
        if (!with_holes || !without.count({i, k})) {
          const Vec3 a = corner + from + static_cast<double>(i) * u + static_cast<double>(k) * v;
          add_quad(m, a, a + u, a + u + v, a + v);
        }
  };
  wall(Vec3::Zero(), z, y, true);
  wall(s * x, y, z, false);
  wall(Vec3::Zero(), x, z, false);
  wall(s * y, z, x, false);
  wall(Vec3::Zero(), y, x, false);
  wall(s * z, x, y, false);
  return m;
}

RC_GTEST_PROP(CapHoles, RectanglesMissingInAWallAreClosedFlat, ()) {
  constexpr int n = 8;
  std::set<std::pair<int, int>> without;
  std::size_t holes = 0;
  for (const int band : {1, 4}) {  // two squares high; the rock between the bands stays
    if (*rc::gen::inRange(0, 3) == 0) continue;
    ++holes;
    const int low = *rc::gen::inRange(0, 2), from = *rc::gen::inRange(1, n - 1),
              to = *rc::gen::inRange(from, n - 1);
    for (int i = band + low; i <= band + 1; ++i)
      for (int k = from; k <= to; ++k) without.insert({i, k});
  }
  RC_ASSERT(is_closed_and_oriented(box_with_holes(n, {})));
  const Capped c = cap_holes(RayScene(box_with_holes(n, without)), 100);
  RC_ASSERT(c.loops.size() == holes);
  double area_m2 = 0;
  for (const cave::CapOfLoop& l : c.loops) {
    RC_ASSERT(l.left == LeftOpen::no);
    area_m2 += l.loop.area_m2;
  }
  RC_ASSERT(std::abs(area_m2 - static_cast<double>(without.size())) < 1e-4);
  RC_ASSERT(is_closed_and_oriented(c.mesh));
  RC_ASSERT(std::abs(enclosed_m3(c.mesh) - n * n * n) < 1e-3);
}

}  // namespace
}  // namespace karst::test
