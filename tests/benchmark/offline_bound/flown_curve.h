// Coverage over time of a way that is given, counted over all cells.
#pragma once
#include <vector>

#include "sdk/evaluation/metrics/coverage_curve.h"
#include "sdk/evaluation/record/poses.h"
#include "tests/benchmark/offline_bound/sight.h"
#include "tests/benchmark/offline_bound/tour_search.h"

namespace karst::bound {

struct Look {
  double time_s;  // from take-off
  core::Vec3 place;
};
using Curve = std::vector<evaluation::CoveragePoint>;

/// A point for each look that shows something; `centres` are those of all cells of R.
Curve curve_of(const cave::RayScene& scene, const std::vector<Eye>& eyes,
               const std::vector<core::Vec3>& centres, double cell_m3, const std::vector<Look>& looks);

/// Looks `period_s` apart along a polyline flown with this timing; the first is at 0.
std::vector<Look> looks_along(const std::vector<core::Vec3>& way, const TourTiming& timing, double period_s);

/// Looks `period_s` apart from where a vehicle truly was, up to `end_s`, times from `begin_s` on.
std::vector<Look> looks_of(const std::vector<evaluation::StampedPose>& truth, double begin_s, double end_s,
                           double period_s);

/// Where it was, without what is less than 0.1 m long.
std::vector<core::Vec3> way_of(const std::vector<evaluation::StampedPose>& truth, double begin_s,
                               double end_s);

}  // namespace karst::bound
