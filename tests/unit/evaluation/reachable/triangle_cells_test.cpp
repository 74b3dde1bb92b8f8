#include "sdk/evaluation/reachable/triangle_cells.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <vector>

#include "plugins/simulator/cave/closest_point.h"

namespace {

using karst::core::Vec3;
using namespace karst::evaluation;

Vec3 place(double span) {
  const auto one = [&] { return *rc::gen::inRange(-1000, 1001) * 1e-3 * span; };
  const double x = one(), y = one(), z = one();
  return {x, y, z};
}

/// Oracle: cut the triangle by the box's six half spaces (Sutherland-Hodgman); what is left is in the box.
/// With the box grown by `extra`.
bool clipped_to_nothing(const Triangle& t, const Vec3& center, const Vec3& half, double extra) {
  std::vector<Vec3> polygon{t.a - center, t.b - center, t.c - center};
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      std::vector<Vec3> kept;
      const auto depth = [&](const Vec3& p) { return half[axis] + extra - sign * p[axis]; };
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double dp = depth(p), dq = depth(q);
        if (dp >= 0) kept.push_back(p);
        if ((dp >= 0) != (dq >= 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
      }
      polygon = std::move(kept);
    }
  return polygon.empty();
}

RC_GTEST_PROP(TriangleBox, AgreesWithClipping, ()) {
  const Triangle t{place(2), place(2), place(2)};
  const Vec3 half = (place(1).cwiseAbs() + Vec3::Constant(0.05));
  const Vec3 center = place(1);
  const bool overlaps = overlaps_box(t, center, half);
  // Where the two rounding errors matter, either answer is right.
  if (clipped_to_nothing(t, center, half, 1e-9)) RC_ASSERT(!overlaps);
  if (!clipped_to_nothing(t, center, half, -1e-9)) RC_ASSERT(overlaps);
}

TEST(TriangleBox, TouchingCounts) {
  const Triangle t{{1, -1, -1}, {1, 1, -1}, {1, 0, 1}};
  EXPECT_TRUE(overlaps_box(t, Vec3::Zero(), Vec3::Ones()));
  EXPECT_FALSE(overlaps_box(t, Vec3(-1e-9, 0, 0), Vec3::Ones()));
}

TEST(TriangleBox, SeparatedOnlyByAnEdgeProduct) {
  // Passes the box's corner: its bounding box overlaps and its plane cuts the box.
  const Triangle t{{0, 2.1, 0.5}, {2.1, 0, -0.5}, {2.1, 2.1, 0}};
  EXPECT_FALSE(overlaps_box(t, Vec3::Zero(), Vec3::Ones()));
  EXPECT_TRUE(overlaps_box(t, Vec3::Zero(), Vec3::Constant(1.1)));
}

RC_GTEST_PROP(InsertTouched, MarksExactlyTheCellsTouched, ()) {
  const double edge = 0.25;
  const Triangle t{place(1.5), place(1.5), place(1.5)};
  const CellKey low{-12, -12, -12}, high{12, 12, 12};
  CellSet cells(low, high);
  insert_touched(cells, t, edge);
  for (CellKey k = low; k.z <= high.z; ++k.z)
    for (k.y = low.y; k.y <= high.y; ++k.y)
      for (k.x = low.x; k.x <= high.x; ++k.x) {
        const Vec3 center = edge * Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5);
        RC_ASSERT(cells.contains(k) == overlaps_box(t, center, Vec3::Constant(edge / 2)));
      }
}

RC_GTEST_PROP(RemoveNear, RemovesExactlyTheCentresThatAreNear, ()) {
  const double edge = 0.25, distance = *rc::gen::inRange(10, 120) * 0.01;
  const Triangle t{place(1.5), place(1.5), place(1.5)};
  const CellKey low{-12, -12, -12}, high{12, 12, 12};
  CellSet cells(low, high);
  for (CellKey k = low; k.z <= high.z; ++k.z)
    for (k.y = low.y; k.y <= high.y; ++k.y)
      for (k.x = low.x; k.x <= high.x; ++k.x) cells.insert(k);
  remove_near(cells, t, edge, distance);
  for (CellKey k = low; k.z <= high.z; ++k.z)
    for (k.y = low.y; k.y <= high.y; ++k.y)
      for (k.x = low.x; k.x <= high.x; ++k.x) {
        const Vec3 p = edge * Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5);
        const double d = (karst::cave::closest_on_triangle(p, t.a, t.b, t.c) - p).norm();
        if (std::abs(d - distance) > 1e-9) RC_ASSERT(cells.contains(k) == (d > distance));
      }
}

}  // namespace
