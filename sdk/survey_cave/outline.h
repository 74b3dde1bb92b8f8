// The outline of a passage in the plane of a cross-section: a polygon around the station.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::survey_cave {

using Vec2 = Eigen::Vector2d;

/// Corners counter-clockwise from the left (x) over the top (y). Corners of the same index of two outlines
/// correspond.
constexpr std::size_t kCorners = 32;
struct Outline {
  std::array<Vec2, kCorners> corners;
};

/// Distances from the station to the walls.
struct Extents {
  double left_m = 1, right_m = 1, up_m = 1, down_m = 1;
};

/// Exponent of the superellipse |x/a|^p + |y/b|^p = 1: between an ellipse (2) and a rectangle. With a and b
/// from the quadrant, its area is (left + right)(up + down) G(1 + 1/p)^2 / G(1 + 2/p), G the gamma function.
constexpr double kExponent = 2.5;
Outline superellipse(const Extents& extents);

/// Through points on the wall: between neighbours, as seen from the station, the distance to the wall is
/// linear in the angle. Where no point lies within 30 degrees of left, up, right or down, the extent there
/// counts as one. Points within 5 degrees of each other are one, their mean.
Outline through_points(const std::vector<Vec2>& points, const Extents& extents);

/// Widened and heightened about its middle to at least `least_m`.
Outline at_least(const Outline& outline, double least_m);

Vec2 size_of(const Outline& outline);    // width and height
Vec2 middle_of(const Outline& outline);  // of its box

/// Distance to the polygon a + t (b - a), negative inside; exact.
double distance_to(const Outline& a, const Outline& b, double t, const Vec2& p);

}  // namespace karst::survey_cave
