#include "core_stack/mission/world_model/world_model.h"

#include <algorithm>
#include <cmath>

#include "core_stack/mapping/region/flight_region.h"
#include "core_stack/planning/planner.h"
#include "core_stack/planning/search/grid_planner.h"

namespace karst::core {
namespace {

/// A path is narrow where no place within this distance has the usual clearance.
constexpr double kBesideNarrow_m = 0.8;

bool starts_clear(const VoxelMap& map, const ClearanceRoadmap& on, const Vec3& from) {
  return is_clear(map, from, search_clearance_m(on.planning(), map.resolution_m()));
}

}  // namespace

WorldModel::WorldModel(const CoreOptions& options, const VehicleDescription& vehicle)
    : launch_clear_radius_m_(options.mission.launch_clear_radius_m),
      rgb_(vehicle.rgb),
      map_(options.map),
      frontiers_(options.frontiers),
      survey_(options.survey),
      usual_(options.planning, Passages::usual),
      narrow_clearance_m_(narrow_clearance_m(options.planning, vehicle.radius_m)),
      home_(vehicle.T_world_start.position + Vec3(0, 0, options.mission.takeoff_height_m)) {
  if (survey_.passages) unsurveyed_.emplace(survey_.passages);
  map_.confine(options.region);
}

std::vector<CellChange> WorldModel::integrate(const std::vector<Ray>& rays) {
  return take_in(map_.insert(rays));
}

std::vector<CellChange> WorldModel::declare_launch_site(const Vec3& hover_point) {
  return take_in(map_.declare_free(hover_point, launch_clear_radius_m_));
}

std::vector<CellChange> WorldModel::take_earlier(std::span<const CellValue> cells) {
  return take_in(map_.fill_unknown(cells));
}

void WorldModel::note_picture(const Pose& T_world_camera) {
  if (rgb_) imaged_.take(map_, T_world_camera, *rgb_);
}

std::vector<CellChange> WorldModel::take_in(std::vector<CellChange> changes) {
  frontiers_.update(map_, changes);
  usual_.note(changes);
  if (narrow_) narrow_->note(changes);
  if (unsurveyed_) unsurveyed_->note(map_, changes);
  return changes;
}

const ClearanceRoadmap& WorldModel::usual() {
  usual_.update(map_, home_);
  return usual_;
}

const ClearanceRoadmap* WorldModel::narrow() {
  if (!narrow_clearance_m_) return nullptr;
  if (!narrow_) narrow_ = narrow_roadmap(map_, usual_.planning(), *narrow_clearance_m_);
  narrow_->update(map_, home_);
  return &*narrow_;
}

/// Inside a narrow passage the path continues through it. Updates both roadmaps: otherwise changes would
/// accumulate in an unused narrow one.
const ClearanceRoadmap& WorldModel::roadmap_at(const Vec3& from) {
  const ClearanceRoadmap& usual_one = usual();
  const ClearanceRoadmap* const narrow_one = narrow_if_made();
  if (!narrow_one) return usual_one;
  return !starts_clear(map_, usual_one, from) && starts_clear(map_, *narrow_one, from) ? *narrow_one
                                                                                       : usual_one;
}

Path WorldModel::plan(const ClearanceRoadmap& on, const Vec3& from, const Vec3& to) const {
  Path path;
  if (to == home_ && is_clear(map_, home_, on.clearance_m()))
    if (const Path raw = on.path_home(map_, from); raw.found())
      path = plan_along(map_, on.roadmap(), raw, on.planning());
  if (!path.found()) path = core::plan(map_, on.roadmap(), from, to, on.planning());
  if (on.passages() == Passages::narrow) mark_narrow_places(map_, usual_.clearance_m(), path);
  if (path.found() && to != home_ && leads_too_far(on, path.points)) {
    path = Path{};
    path.reason = "it leads farther from home than region.max_home_distance";
  }
  return path;
}

bool WorldModel::too_far_from_home(const ClearanceRoadmap& on, const Vec3& p) const {
  if (!map_.region() || !map_.region()->limits().max_home_m) return false;
  const std::optional<double> length_m = on.home_length_m(map_, p);
  return !length_m || *length_m > *map_.region()->limits().max_home_m;
}

/// Where the path home is not known for the moment, near an obstacle, the places beside it decide. A vehicle
/// that is too far already may go no farther.
bool WorldModel::leads_too_far(const ClearanceRoadmap& on, const std::vector<Vec3>& points) const {
  if (!map_.region() || !map_.region()->limits().max_home_m || points.empty()) return false;
  constexpr double kSpacing_m = 1.0;
  const double most_m = std::max(*map_.region()->limits().max_home_m,
                                 on.home_length_m(map_, points.front()).value_or(0) + kSpacing_m);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec3 along = points[i] - points[i - 1];
    const int pieces = std::max(1, static_cast<int>(std::ceil(along.norm() / kSpacing_m)));
    for (int k = 1; k <= pieces; ++k)
      if (on.home_length_m(map_, points[i - 1] + along * k / pieces).value_or(0) > most_m) return true;
  }
  return too_far_from_home(on, points.back());
}

Path WorldModel::plan_to(const Vec3& from, const Vec3& to) {
  const ClearanceRoadmap& first = roadmap_at(from);
  Path path = plan(first, from, to);
  if (path.found() || first.passages() == Passages::narrow) return path;
  const ClearanceRoadmap* const narrow_one = narrow();
  return narrow_one ? plan(*narrow_one, from, to) : path;
}

double WorldModel::narrow_length_m(const Path& path) const {
  double narrow_m = 0;
  for (std::size_t i = 1; i < path.points.size(); ++i)
    if (!usual_.roadmap().approach(map_, path.points[i], kBesideNarrow_m))
      narrow_m += (path.points[i] - path.points[i - 1]).norm();
  return narrow_m;
}

}  // namespace karst::core
