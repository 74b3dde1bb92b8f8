#include "core_stack/mission/explorer.h"

#include "core_stack/planning/free_tiles.h"
#include "core_stack/planning/grid_planner.h"
#include "core_stack/planning/planner.h"

namespace karst::core {
namespace {

/// A path under way is judged a little milder than a new one, or noise would stop every flight.
constexpr double kClearanceSlack_m = 0.12;
/// A cluster that has lost this share of its cells has been seen; flying on to it is a waste.
constexpr double kSeenShare = 0.75;

/// Way back: poses nearer than this are joined directly, if the line is clear by this much beyond the radius.
constexpr double kShortcut_m = 2.0, kShortcutMargin_m = 0.15;

/// A way is narrow where no place this near to it is clear by the usual clearance.
constexpr double kBesideNarrow_m = 0.8;

}  // namespace

Explorer::Explorer(const CoreOptions& options, const VehicleDescription& vehicle, PolicyPort& policy)
    : options_(options),
      vehicle_(vehicle),
      view_(steepest_view(vehicle)),
      policy_(&policy),
      map_(options.map),
      frontiers_(options.frontiers),
      wide_(options.planning),
      narrow_clearance_m_(narrow_clearance_m(options.planning, vehicle.radius_m)),
      home_(vehicle.T_world_start.position + Vec3(0, 0, options.mission.takeoff_height_m)) {}

std::vector<CellChange> Explorer::integrate(const std::vector<Ray>& rays) {
  return take_in(map_.insert(rays));
}

std::vector<CellChange> Explorer::declare_launch_site(const Vec3& hover_point) {
  return take_in(map_.declare_free(hover_point, options_.mission.launch_clear_radius_m));
}

void Explorer::note_picture(const Pose& T_world_camera) {
  if (vehicle_.rgb) imaged_.take(map_, T_world_camera, *vehicle_.rgb);
}

std::vector<CellChange> Explorer::take_in(std::vector<CellChange> changes) {
  frontiers_.update(map_, changes);
  wide_.due.insert(wide_.due.end(), changes.begin(), changes.end());
  if (narrow_) narrow_->due.insert(narrow_->due.end(), changes.begin(), changes.end());
  if (homing_)
    for (const CellChange& c : changes)
      if (c.after == Cell::occupied) closed_.push_back(c.key);
  return changes;
}

Reach& Explorer::wide() {
  wide_.update(map_, home_);
  return wide_;
}

Reach* Explorer::narrow() {
  if (!narrow_clearance_m_) return nullptr;
  if (!narrow_) narrow_ = narrow_reach(map_, options_.planning, *narrow_clearance_m_);
  narrow_->update(map_, home_);
  return &*narrow_;
}

/// Inside a narrow passage the way on leads through it. Brings both up to date: changes that the narrow one
/// has yet to hear of would pile up while there is no need for it.
Reach& Explorer::reach_at(const Vec3& from) {
  Reach& usual = wide();
  if (!narrow_) return usual;
  Reach& tight = *narrow();
  const auto clear = [&](const Reach& reach) {
    return is_clear(map_, from, search_clearance_m(reach.planning, map_.resolution_m()));
  };
  return !clear(usual) && clear(tight) ? tight : usual;
}

std::optional<double> Explorer::hull_clearance_m(const Vec3& p) const {
  const double limit_m = vehicle_.radius_m + 0.5;
  FreeTiles free(map_.resolution_m());
  free.load_near(map_, p, limit_m);
  const double distance_m = free.nearest(p, limit_m).distance_m - map_.resolution_m() / 2;
  if (distance_m >= limit_m - map_.resolution_m()) return std::nullopt;
  return distance_m - vehicle_.radius_m;
}

Vec3 Explorer::hover_below(const Vec3& highest) const {
  constexpr double kStep_m = 0.05;
  const double enough_m = options_.planning.clearance_m - vehicle_.radius_m;
  Vec3 best = highest;
  double most_m = -1;
  for (Vec3 p = highest; most_m < enough_m; p.z() -= kStep_m) {
    const double above_ground_m = p.z() - vehicle_.T_world_start.position.z();  // the hull touched it there
    if (above_ground_m <= most_m) break;
    const double room_m = std::min(above_ground_m, hull_clearance_m(p).value_or(above_ground_m));
    if (room_m <= most_m) continue;
    most_m = room_m;
    best = p;
  }
  return best;
}

bool Explorer::cluster_alive(std::uint32_t id) const {
  const auto it = frontiers_.clusters().find(id);
  if (it == frontiers_.clusters().end()) return false;
  const auto chosen = chosen_.find(id);
  return chosen == chosen_.end() || static_cast<double>(it->second.cells.size()) >=
                                        (1 - kSeenShare) * static_cast<double>(chosen->second.cells);
}

/// How much of the way home through narrow passages is narrow: flown slowly, it takes longer.
double Explorer::narrow_length_m(const Path& way) const {
  double narrow_m = 0;
  for (std::size_t i = 1; i < way.points.size(); ++i)
    if (!wide_.roadmap.approach(map_, way.points[i], kBesideNarrow_m))
      narrow_m += (way.points[i] - way.points[i - 1]).norm();
  return narrow_m;
}

double Explorer::slow_mps() const { return options_.safety.slow_share * options_.motion.max_speed_mps; }

HomeEstimate Explorer::estimate_home(const Vec3& from, double way_come_m) {
  const HomeEstimate base = estimate_base(from, way_come_m);
  const std::optional<LandingSpot> spot = nearest_spot(from, base.time_s);
  return spot ? HomeEstimate{spot->length_m, spot->time_s} : base;
}

HomeEstimate Explorer::estimate_base(const Vec3& from, double way_come_m) {
  const Reach& usual = wide();
  std::optional<double> length_m = usual.way_home.length_m(map_, usual.roadmap, from);
  double narrow_m = 0;
  if (!length_m && narrow_) {
    const Reach& tight = *narrow();
    length_m = tight.way_home.length_m(map_, tight.roadmap, from);
    if (length_m) narrow_m = narrow_length_m(tight.way_home.find(map_, tight.roadmap, from));
  }
  const double all_m = length_m.value_or(way_come_m);
  return {all_m, narrow_m / slow_mps() + home_time_s(all_m, vehicle_.T_world_start.position.z(), home_.z(),
                                                     options_.motion, options_.mission.landing_speed_mps)};
}

std::vector<Vec3> Explorer::way_back(const std::vector<Vec3>& flown) const {
  std::vector<Vec3> back;
  const double clearance_m = vehicle_.radius_m + kShortcutMargin_m;
  for (std::size_t i = flown.size(); i-- > 0;) {
    back.push_back(flown[i]);
    // The earliest pose that can be joined shortens the way most. To the one before leads what was flown.
    for (std::size_t j = 0; j + 1 < i; ++j)
      if ((flown[j] - flown[i]).norm() < kShortcut_m &&
          segment_clear(map_, flown[i], flown[j], clearance_m)) {
        i = j + 1;
        break;
      }
  }
  back.push_back(home_);
  return back;
}

Path Explorer::plan_in(const Reach& reach, const Vec3& from, const Vec3& to) const {
  Path path;
  if (to == home_ && is_clear(map_, home_, reach.planning.clearance_m))
    if (const Path way = reach.way_home.find(map_, reach.roadmap, from); way.found())
      path = plan_along(map_, reach.roadmap, way, reach.planning);
  if (!path.found()) path = plan(map_, reach.roadmap, from, to, reach.planning);
  if (&reach != &wide_) mark_narrow_places(map_, options_.planning.clearance_m, path);
  return path;
}

Path Explorer::plan_to(const Vec3& from, const Vec3& to) {
  const Reach& reach = reach_at(from);
  Path path = plan_in(reach, from, to);
  if (path.found() || &reach != &wide_) return path;
  const Reach* const tight = narrow();
  return tight ? plan_in(*tight, from, to) : path;
}

int Explorer::touching_segment(const std::vector<Vec3>& points) const {
  return first_blocked_segment(map_, points, vehicle_.radius_m);
}

int Explorer::blocked_segment(const std::vector<Vec3>& points, const std::vector<Vec3>& narrow_places) const {
  const double usual_m = options_.planning.clearance_m - kClearanceSlack_m;
  const double narrow_m = narrow_clearance_m_ ? vehicle_.radius_m : usual_m;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    if (!segment_clear(map_, points[i], points[i + 1], usual_m) &&
        !(near_narrow_place(narrow_places, points[i], points[i + 1]) &&
          segment_clear(map_, points[i], points[i + 1], narrow_m)))
      return static_cast<int>(i);
  return -1;
}

}  // namespace karst::core
