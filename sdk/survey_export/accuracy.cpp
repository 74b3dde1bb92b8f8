#include "sdk/survey_export/accuracy.h"

#include <algorithm>
#include <cmath>

namespace karst::survey_export {

double Accuracy::leg_sd_m(double length_m) const {
  return std::sqrt(cell_m * cell_m / 6 + growth_m2_per_m * length_m);
}

Accuracy accuracy_of(const evaluation::Table& localization,
                     const std::vector<evaluation::StampedPose>& estimate, double cell_m) {
  constexpr double kMoved_m = 0.01, kJumped_m = 2;  // between scans: the estimate, and not the vehicle
  Accuracy out;
  out.cell_m = cell_m;
  const std::vector<double>* stamps_s = localization.column("stamp_s");
  const std::vector<double>* sigmas_m = localization.column("position_sigma_m");
  if (stamps_s == nullptr || sigmas_m == nullptr || estimate.empty()) return out;
  double variance_m2 = 0;
  core::Vec3 last = pose_at(estimate, estimate.front().t_s).position;
  for (std::size_t i = 0; i < std::min(stamps_s->size(), sigmas_m->size()); ++i) {
    const double sigma_m = (*sigmas_m)[i];
    if (!std::isfinite((*stamps_s)[i]) || !std::isfinite(sigma_m)) continue;
    const core::Vec3 here = pose_at(estimate, (*stamps_s)[i]).position;
    const double moved_m = (here - last).norm();
    if (moved_m < kMoved_m) continue;
    last = here;
    if (!(moved_m < kJumped_m)) continue;
    variance_m2 += sigma_m * sigma_m;
    out.flown_m += moved_m;
    ++out.scans;
  }
  if (out.flown_m > 0) out.growth_m2_per_m = variance_m2 / out.flown_m;
  return out;
}

}  // namespace karst::survey_export
