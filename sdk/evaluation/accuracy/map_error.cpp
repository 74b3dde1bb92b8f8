#include "sdk/evaluation/accuracy/map_error.h"

#include <cmath>

namespace karst::evaluation {

using core::Vec3;

std::vector<Vec3> occupied_centres(const core::VoxelMap& map) {
  std::vector<Vec3> centres;
  centres.reserve(map.occupied_cells());
  map.for_each_known([&](const core::CellKey& k, core::Cell c, float) {
    if (c == core::Cell::occupied) centres.push_back(map.center_of(k));
  });
  return centres;
}

std::vector<double> map_errors(const std::vector<Vec3>& points,
                               const std::function<double(const Vec3&)>& distance_m) {
  std::vector<double> errors;
  errors.reserve(points.size());
  for (const Vec3& p : points)
    if (const double d = distance_m(p); std::isfinite(d)) errors.push_back(std::abs(d));
  return errors;
}

}  // namespace karst::evaluation
