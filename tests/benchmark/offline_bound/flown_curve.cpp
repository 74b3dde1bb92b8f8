#include "tests/benchmark/offline_bound/flown_curve.h"

#include <algorithm>
#include <numeric>

namespace karst::bound {

using core::Vec3;

Curve curve_of(const cave::RayScene& scene, const std::vector<Eye>& eyes, const std::vector<Vec3>& centres,
               double cell_m3, const std::vector<Look>& looks) {
  std::vector<std::uint32_t> unseen(centres.size());
  std::iota(unseen.begin(), unseen.end(), 0u);
  Curve curve{{0, 0, 0}};
  for (const Look& look : looks) {
    const std::vector<std::uint32_t> seen = seen_from(scene, eyes, look.place, centres, unseen);
    if (seen.empty()) continue;
    std::vector<std::uint32_t> rest;
    std::set_difference(unseen.begin(), unseen.end(), seen.begin(), seen.end(), std::back_inserter(rest));
    unseen = std::move(rest);
    const auto count = static_cast<double>(centres.size() - unseen.size());
    const evaluation::CoveragePoint p{std::max(0.0, look.time_s), count * cell_m3,
                                      count / static_cast<double>(centres.size())};
    if (p.time_s > curve.back().time_s) {
      curve.push_back(p);
    } else {
      curve.back() = p;
    }
  }
  return curve;
}

std::vector<Look> looks_along(const std::vector<Vec3>& way, const TourTiming& timing, double period_s) {
  std::vector<Look> looks{{0, way.front()}};
  std::size_t i = 1;
  double before_m = 0;  // to way[i - 1]
  for (double t = timing.begin_s; t <= timing.end_s; t += period_s) {
    const double length_m = timing.length_m(t);
    double step_m = 0;
    for (; i < way.size(); ++i, before_m += step_m) {
      step_m = (way[i] - way[i - 1]).norm();
      if (before_m + step_m >= length_m) break;
    }
    if (i == way.size()) {
      looks.push_back({t, way.back()});
      break;
    }
    const double share = step_m > 0 ? (length_m - before_m) / step_m : 0;
    looks.push_back({t, way[i - 1] + share * (way[i] - way[i - 1])});
  }
  return looks;
}

std::vector<Look> looks_of(const std::vector<evaluation::StampedPose>& truth, double begin_s, double end_s,
                           double period_s) {
  std::vector<Look> looks;
  double next_s = 0;
  for (const evaluation::StampedPose& p : truth) {
    if (p.t_s < next_s || p.t_s > end_s) continue;
    looks.push_back({p.t_s - begin_s, p.T_world_body.position});
    next_s = p.t_s + period_s - 1e-6;
  }
  return looks;
}

std::vector<Vec3> way_of(const std::vector<evaluation::StampedPose>& truth, double begin_s, double end_s) {
  std::vector<Vec3> way;
  for (const evaluation::StampedPose& p : truth)
    if (p.t_s >= begin_s && p.t_s <= end_s &&
        (way.empty() || (p.T_world_body.position - way.back()).norm() >= 0.1))
      way.push_back(p.T_world_body.position);
  return way;
}

}  // namespace karst::bound
