#include "sdk/cave_from_cloud/usable_points.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "sdk/cave_from_cloud/poisson.h"
#include "sdk/cave_from_cloud/thin_out.h"

namespace karst::from_cloud {

using core::format_text;
using core::InputError;

namespace {

double whole_centimetres_up(double v_m) { return std::ceil(v_m * 100 - 1e-9) / 100; }

double side_m(const PointCloud& cloud) {
  Eigen::AlignedBox3f box;
  for (const core::Vec3f& p : cloud.points) box.extend(p);
  return box.isEmpty() ? 0 : static_cast<double>(box.sizes().maxCoeff());
}

/// Thinned to the resolution, without lonely points.
PointCloud thinned_points(const std::string& path, const PointCloud& cloud, CloudReport& report) {
  constexpr double kGap_cells = 3;
  constexpr std::size_t kLeast = 20;
  for (const core::Vec3f& p : cloud.points)
    if (static_cast<double>(p.cwiseAbs().maxCoeff()) >= kMostVoxels * report.resolution_m)
      throw InputError(path, "",
                       format_text("its points reach %.1f km: too far for a resolution of %g m",
                                   static_cast<double>(p.cwiseAbs().maxCoeff()) / 1000, report.resolution_m));
  const PointCloud thin = thinned(cloud, report.resolution_m);
  PointCloud kept = without_lonely(thin, kGap_cells * report.resolution_m, kLeast);
  report.thinned = thin.points.size();
  report.lonely = thin.points.size() - kept.points.size();
  return kept;
}

}  // namespace

PointCloud usable_points(const std::string& path, const PointCloud& cloud, double given_m,
                         CloudReport& report) {
  constexpr double kFinest_m = 0.1, kCells_a_spacing = 2;
  constexpr std::size_t kLeastPoints = 100;
  report.spacing_m = spacing_m(cloud);
  report.resolution_m =
      given_m > 0 ? given_m : std::max(kFinest_m, whole_centimetres_up(kCells_a_spacing * report.spacing_m));
  PointCloud usable = thinned_points(path, cloud, report);
  if (const double side = side_m(usable); side > longest_side_m(report.resolution_m)) {
    const double coarser_m =
        whole_centimetres_up(report.resolution_m * side / longest_side_m(report.resolution_m));
    if (given_m > 0)
      throw InputError(path, "",
                       format_text("is %.0f m long: too long for a resolution of %g m; --resolution %g is "
                                   "coarse enough",
                                   side, given_m, coarser_m));
    report.resolution_m = coarser_m;
    usable = thinned_points(path, cloud, report);
  }
  if (usable.points.size() < kLeastPoints)
    throw InputError(path, "",
                     format_text("leaves %zu of %zu points at a resolution of %g m: too few for a surface",
                                 usable.points.size(), report.thinned, report.resolution_m));
  return usable;
}

}  // namespace karst::from_cloud
