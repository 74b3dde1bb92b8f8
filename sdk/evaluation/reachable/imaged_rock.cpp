#include "sdk/evaluation/reachable/imaged_rock.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace karst::evaluation {
namespace {

using core::Vec3;
using core::Vec3f;

/// Unit vectors in the camera's frame, row by row.
std::vector<Vec3f> rays_of(const PicturePose& p, double resolution_m) {
  const double step = 0.5 * resolution_m / p.max_range_m;  // on the image plane at distance 1
  const auto columns = static_cast<int>(std::ceil(2 * p.tan_half_width / step));
  const auto rows = static_cast<int>(std::ceil(2 * p.tan_half_height / step));
  std::vector<Vec3f> rays;
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column)
      rays.push_back(
          Vec3(1, p.tan_half_width * (1 - 2.0 * column / columns), p.tan_half_height * (1 - 2.0 * row / rows))
              .normalized()
              .cast<float>());
  return rays;
}

bool same_optics(const PicturePose& a, const PicturePose& b) {
  return a.tan_half_width == b.tan_half_width && a.tan_half_height == b.tan_half_height &&
         a.max_range_m == b.max_range_m;
}

bool same_view(const PicturePose& a, const PicturePose& b) {
  constexpr double kDegree = 0.017453292519943295;
  return same_optics(a, b) && (a.T_world_camera.position - b.T_world_camera.position).norm() < 0.01 &&
         a.T_world_camera.orientation.angularDistance(b.T_world_camera.orientation) < 0.1 * kDegree;
}

}  // namespace

std::vector<CellKey> imaged_rock(const cave::RayScene& scene, std::span<const PicturePose> pictures,
                                 double resolution_m) {
  std::unordered_set<CellKey, core::CellKeyHash> cells;
  std::vector<Vec3f> directions;
  std::vector<cave::Ray> rays;
  std::vector<cave::Hit> hits;
  const PicturePose* last = nullptr;
  for (const PicturePose& p : pictures) {
    if (last && same_view(*last, p)) continue;
    if (!last || !same_optics(*last, p)) directions = rays_of(p, resolution_m);
    last = &p;
    const Eigen::Matrix3f R = p.T_world_camera.orientation.toRotationMatrix().cast<float>();
    const Vec3f eye = p.T_world_camera.position.cast<float>();
    rays.resize(directions.size());
    hits.resize(directions.size());
    for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = {eye, R * directions[i]};
    scene.cast(rays, static_cast<float>(p.max_range_m), hits);
    const auto min_cosine = static_cast<float>(std::cos(p.max_incidence_rad));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const cave::Hit& hit = hits[i];
      if (!hit.any() || static_cast<double>(hit.range_m) < p.min_range_m) continue;
      if (-hit.normal.dot(rays[i].direction) < min_cosine) continue;
      const Vec3 place = (eye + hit.range_m * rays[i].direction).cast<double>() / resolution_m;
      const auto key = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
      cells.insert({key(place.x()), key(place.y()), key(place.z())});
    }
  }
  std::vector<CellKey> sorted(cells.begin(), cells.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

}  // namespace karst::evaluation
