#include "candidates.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace surface_coverage {
namespace {

constexpr double kApart_m = 1.0;  // between viewpoints for one patch
constexpr double kMargin_rad =
    4 * kDegree;  // to the limits of view and incidence, for errors of estimate and map

/// 1..6 for +-x, +-y, +-z; 0 for no direction.
int facing(const Vec3& n) {
  const double a[3] = {std::abs(n.x), std::abs(n.y), std::abs(n.z)}, v[3] = {n.x, n.y, n.z};
  const auto axis = std::max_element(a, a + 3) - a;
  return a[axis] == 0 ? 0 : 1 + 2 * static_cast<int>(axis) + (v[axis] < 0 ? 1 : 0);
}

/// Heading of the body when the camera, mounted at some yaw, looks along `azimuth_rad`.
double heading_for(const ImagingCamera& camera, double azimuth_rad) {
  const karst_quaternion_t& q = camera.sensor.T_body_sensor.orientation;
  const double yaw = std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
  return std::remainder(azimuth_rad - yaw, 2 * kPi);
}

/// Elevation of the optical axis above the horizon.
double pitch_of(const ImagingCamera& camera) {
  const karst_quaternion_t& q = camera.sensor.T_body_sensor.orientation;
  return std::asin(std::clamp(2 * (q.x * q.z - q.w * q.y), -1.0, 1.0));
}

}  // namespace

std::vector<Patch> patches_of(const std::vector<SurfaceCell>& cells, double edge_m) {
  std::map<std::pair<CellId, int>, std::vector<const SurfaceCell*>> groups;
  for (const SurfaceCell& c : cells) groups[{cell_id(c.center, edge_m), facing(c.normal)}].push_back(&c);
  std::vector<Patch> patches;
  for (const auto& [place, group] : groups) {
    Vec3 center, normal;
    for (const SurfaceCell* c : group) {
      center = center + c->center;
      normal = normal + c->normal;
    }
    center = (1.0 / static_cast<double>(group.size())) * center;
    // The mean of cells around a corner may lie in the rock, or in the air: the cell nearest to it represents
    // the group.
    const auto nearest =
        std::min_element(group.begin(), group.end(), [&](const SurfaceCell* a, const SurfaceCell* b) {
          return distance(a->center, center) < distance(b->center, center);
        });
    const double length = norm(normal);
    patches.push_back({(*nearest)->center, length > 0 ? (1 / length) * normal : Vec3(), group.size()});
  }
  return patches;
}

std::vector<bool> clear_places(const karst::Request& request, const std::vector<Vec3>& places) {
  // Three flat boxes together cover the ball and little more.
  const double c = request.clearance_m, flat = 0.71 * c;
  const Vec3 halves[3] = {{c, flat, flat}, {flat, c, flat}, {flat, flat, c}};
  std::vector<Box> boxes;
  for (const Vec3& p : places)
    for (const Vec3& h : halves) boxes.push_back({p - h, p + h});
  const auto counts = request.map.counts(boxes);
  std::vector<bool> clear(places.size(), true);
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i].unknown > 0 || counts[i].occupied > 0) clear[i / 3] = false;
  return clear;
}

std::vector<Viewpoint> places_for(const karst::Request& request, const ImagingCamera& camera,
                                  const Patch& patch, std::size_t most) {
  constexpr int kAzimuths = 16;
  constexpr double kFractions[] = {0.6, 0.4, 0.8};  // of the range
  const karst::Sensor& s = camera.sensor;
  const double pitch = pitch_of(camera);
  const double low = pitch + s.low_elevation_rad + kMargin_rad,
               high = pitch + s.high_elevation_rad - kMargin_rad;
  const double min_facing = std::cos(camera.max_incidence_rad - kMargin_rad);
  const bool any_side = norm(patch.normal) == 0;
  struct RankedView {
    Viewpoint at;
    double merit;
  };
  std::vector<RankedView> places;
  const double resolution_m = request.map.resolution_m();
  for (int e = 0; e <= 4; ++e) {
    const double elevation = low + (high - low) * e / 4;  // of the patch, seen from the place
    for (int a = 0; a < kAzimuths; ++a) {
      const double azimuth = 2 * kPi * a / kAzimuths;
      const Vec3 there{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                       std::sin(elevation)};
      const double squareness = any_side ? 1 : -dot(there, patch.normal);
      if (squareness < min_facing) continue;
      for (const double fraction : kFractions) {
        const Vec3 eye = patch.center - fraction * s.max_range_m * there;
        const double heading = heading_for(camera, azimuth);
        const Vec3 m = s.T_body_sensor.position;
        const double cos_h = std::cos(heading), sin_h = std::sin(heading);
        const Vec3 body = eye - Vec3(cos_h * m.x - sin_h * m.y, sin_h * m.x + cos_h * m.y, m.z);
        places.push_back({{body, heading}, squareness - 0.5 * std::abs(fraction - 0.6)});
      }
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const RankedView& x, const RankedView& y) { return x.merit > y.merit; });

  // The cheap checks come first: whether a viewpoint is free, then whether the patch is visible, then
  // clearance.
  std::vector<Vec3> centers;
  for (const RankedView& p : places) centers.push_back(p.at.position);
  const std::vector<karst::Cell> cells = request.map.cells(centers);
  const Vec3 target = patch.center + 0.9 * resolution_m * patch.normal;
  std::vector<Viewpoint> open;
  std::vector<karst_segment_t> sights;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (cells[i] == karst::Cell::free) {
      open.push_back(places[i].at);
      sights.push_back({places[i].at.position, target});
    }
  const auto ends = request.map.cast(sights, false);
  std::vector<Viewpoint> out;
  for (std::size_t i = 0; i < open.size() && out.size() < most; ++i) {
    if (ends[i].state != KARST_CELL_FREE) continue;
    const auto same = [&](const Viewpoint& v) { return distance(v.position, open[i].position) < kApart_m; };
    if (std::any_of(out.begin(), out.end(), same)) continue;
    if (clear_places(request, {open[i].position}).front()) out.push_back(open[i]);
  }
  return out;
}

}  // namespace surface_coverage
