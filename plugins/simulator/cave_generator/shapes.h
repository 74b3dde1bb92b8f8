// Signed distances to single shapes, negative inside, in metres; exact or nearly so close to the surface.
#pragma once
#include "plugins/simulator/cave_generator/plan.h"

namespace karst::cave {

/// Minimum with a rounded edge `k` wide (Quilez); the maximum likewise is -smooth_min(-a, -b, k).
double smooth_min(double a, double b, double k);

/// The stretch of a passage between two stations.
struct Segment {
  Segment(const Station& from, const Station& to);
  Station from, to;
  core::Vec3 axis, side, up;
  double length_m, flatness;  // flatness: cosine of the slope
  double reach_m;             // largest distance of the surface from the centre line
};

/// The position of a point relative to a segment's centre line.
struct Foot {
  double along = 0;  // 0 at the first station, 1 at the second
  core::Vec3 offset = core::Vec3::Zero();
};
Foot foot_of(const core::Vec3& p, const Segment& s);
double segment_distance(const Foot& foot, const Segment& s);

double chamber_distance(const core::Vec3& p, const Chamber& c);
double boulder_distance(const core::Vec3& p, const Boulder& b);
double speleothem_distance(const core::Vec3& p, const Speleothem& s);

}  // namespace karst::cave
