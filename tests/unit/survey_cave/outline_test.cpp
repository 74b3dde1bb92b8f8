// Cross-sections and the tubes between them against closed forms.
#include "sdk/survey_cave/outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core_stack/common/random.h"
#include "sdk/survey_cave/tube.h"
#include "tests/unit/survey_cave/surveys.h"

namespace karst::survey_cave {
namespace {

using core::Vec3;

double area_of(const Outline& o) {
  double twice = 0;
  for (std::size_t k = 0; k < kCorners; ++k) {
    const Vec2 &a = o.corners[k], &b = o.corners[(k + 1) % kCorners];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

TEST(Outline, OfLeftRightUpDownHasTheAreaOfASuperellipse) {
  const Outline o = superellipse({2, 0.5, 3, 1});
  EXPECT_NEAR(area_of(o), test::superellipse_m2(2.5, 4), 0.02 * test::superellipse_m2(2.5, 4));
  EXPECT_LT(area_of(o), test::superellipse_m2(2.5, 4)) << "the polygon is inscribed";
  EXPECT_NEAR(size_of(o).x(), 2.5, 1e-9);
  EXPECT_NEAR(size_of(o).y(), 4, 1e-9);
  EXPECT_NEAR(middle_of(o).x(), 0.75, 1e-9);
  EXPECT_NEAR(o.corners[0].x(), 2, 1e-9) << "left is x";
  EXPECT_NEAR(o.corners[kCorners / 4].y(), 3, 1e-9) << "up is y";
}

TEST(Outline, ThroughPointsOfACircleIsTheCircle) {
  std::vector<Vec2> points;
  for (int i = 0; i < 12; ++i) {
    const double a = 2 * std::numbers::pi * i / 12 + 0.1;
    points.emplace_back(1.7 * std::cos(a), 1.7 * std::sin(a));
  }
  for (const Vec2& c : through_points(points, {9, 9, 9, 9}).corners) EXPECT_NEAR(c.norm(), 1.7, 1e-6);
}

TEST(Outline, ThroughPointsTakesTheExtentWhereNoPointIs) {
  const std::vector<Vec2> points{{1, 0.1}, {1, -0.1}, {0.1, 1}, {-0.1, 1}};  // left and up only
  const Outline o = through_points(points, {5, 2, 5, 3});
  EXPECT_NEAR(o.corners[0].x(), std::hypot(1, 0.1), 0.01);
  EXPECT_NEAR(o.corners[kCorners / 2].x(), -2, 1e-6) << "right as noted";
  EXPECT_NEAR(o.corners[3 * kCorners / 4].y(), -3, 1e-6) << "down as noted";
}

TEST(Outline, DistanceIsThatToTheNearestOfManyPointsOnThePolygon) {
  core::Random random(3);
  const Outline a = superellipse({2, 0, 3, 1}), b = superellipse({0.4, 1, 0.5, 2});
  for (int trial = 0; trial < 200; ++trial) {
    const double t = random.uniform();
    const Vec2 p(random.uniform(-3, 3), random.uniform(-3, 4));
    double nearest = 1e9, winding = 0;
    for (std::size_t k = 0; k < kCorners; ++k) {
      const auto at = [&](std::size_t i) -> Vec2 {
        return (1 - t) * a.corners[i % kCorners] + t * b.corners[i % kCorners];
      };
      for (int i = 0; i < 50; ++i)
        nearest = std::min(nearest, (at(k) + i / 50.0 * (at(k + 1) - at(k)) - p).norm());
      const Vec2 u = at(k) - p, v = at(k + 1) - p;
      winding += std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v));
    }
    const bool inside = std::abs(winding) > std::numbers::pi;
    EXPECT_NEAR(distance_to(a, b, t, p), inside ? -nearest : nearest, 0.02) << trial;
  }
}

TEST(Outline, AtLeastWidensWhatIsNarrowerAboutItsMiddle) {
  const Outline o = at_least(superellipse({0.1, 0.3, 1, 1}), 1);
  EXPECT_NEAR(size_of(o).x(), 1, 1e-9);
  EXPECT_NEAR(size_of(o).y(), 2, 1e-9);
  EXPECT_NEAR(middle_of(o).x(), -0.1, 1e-9);
}

TubeEnd end_at(const Vec3& centre, double half_m, bool open = false) {
  TubeEnd e;
  e.centre = centre;
  e.outline = superellipse({half_m, half_m, half_m, half_m});
  e.open = open;
  e.cap_m = half_m;
  return e;
}

TEST(Tube, IsAsWideAsItsOutlineAndRoundedBehindItsEnds) {
  const Tube tube(end_at({0, 0, 0}, 1), end_at({10, 0, 0}, 2), 0, 0);
  EXPECT_NEAR(tube.distance({0.01, 1, 0}), 0, 0.02);
  EXPECT_NEAR(tube.distance({5, 0, 1.5}), 0, 0.02);
  EXPECT_NEAR(tube.distance({9.99, -2, 0}), 0, 0.02);
  EXPECT_NEAR(tube.distance({-1, 0, 0}), 0, 1e-6) << "the cap's end";
  EXPECT_NEAR(tube.distance({-2, 0, 0}), 1, 1e-6);
  EXPECT_NEAR(tube.distance({5, 0, 4}), 2.5, 0.4);
  EXPECT_LT(tube.distance({5, 0, 0}), -1);
  EXPECT_NEAR(tube.size_at(0.5).x(), 3, 1e-9);
}

TEST(Tube, BallsThatItIsSaidToHoldLieInIt) {
  const Tube tube(end_at({0, 0, 0}, 2), end_at({6, 2, -1}, 3), 0, 0);
  core::Random random(5);
  int held = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 p(random.uniform(-2, 8), random.uniform(-3, 5), random.uniform(-3, 3));
    const double radius_m = random.uniform(0.1, 0.8);
    if (!tube.holds_ball(p, radius_m)) {
      EXPECT_LE(tube.far_distance(p), std::max(0.0, tube.distance(p)) + 1e-9);
      continue;
    }
    ++held;
    for (int i = 0; i < 20; ++i) {
      const Vec3 v(random.normal(), random.normal(), random.normal());
      EXPECT_LT(tube.distance(p + radius_m * v.normalized()), 0);
    }
  }
  EXPECT_GT(held, 50);
}

// Where a passage turns, both tubes have the same section, in the plane that halves the angle.
TEST(Tube, OpenEndsOfTwoTubesMeetWithoutAGapOrABulge) {
  const Vec3 half = Vec3(1, 1, 0).normalized();
  TubeEnd first = end_at({-5, 0, 0}, 1), bend = end_at({0, 0, 0}, 1, true), last = end_at({0, 5, 0}, 1);
  bend.normal = half;
  bend.left = Vec3(-1, 1, 0).normalized();
  last.normal = Vec3::UnitY();
  last.left = -Vec3::UnitX();
  const Tube in(first, bend, 0, 0), out(bend, last, 1, 0);
  for (double z = -0.8; z < 0.9; z += 0.2)
    for (double side = -1.2; side < 1.3; side += 0.1) {
      const Vec3 on_plane = side * bend.left + Vec3(0, 0, z);
      const double before =
                       std::min(in.distance(on_plane - 1e-6 * half), out.distance(on_plane - 1e-6 * half)),
                   after =
                       std::min(in.distance(on_plane + 1e-6 * half), out.distance(on_plane + 1e-6 * half));
      EXPECT_EQ(before < 0, after < 0);
      if (std::abs(before) < 0.3) {
        EXPECT_NEAR(before, after, 0.12);
      }
    }
}

}  // namespace
}  // namespace karst::survey_cave
