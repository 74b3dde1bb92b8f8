// Signed distances to single shapes, negative inside, in metres; exact or nearly so close to the surface.
#pragma once
#include "plugins/simulator/cave_generator/plan.h"

namespace karst::cave {

/// Minimum with a rounded edge `k` wide (Quilez); the maximum likewise is -smooth_min(-a, -b, k).
double smooth_min(double a, double b, double k);

double passage_distance(const core::Vec3& p, const Station& from, const Station& to);
double chamber_distance(const core::Vec3& p, const Chamber& c);
double boulder_distance(const core::Vec3& p, const Boulder& b);
double speleothem_distance(const core::Vec3& p, const Speleothem& s);
double line_distance(const core::Vec3& p, const core::Vec3& a, const core::Vec3& b);

}  // namespace karst::cave
