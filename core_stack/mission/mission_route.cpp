// From a path to what is flown: joined to the trajectory under way, and timed.
#include <nlohmann/json.hpp>

#include "core_stack/mission/mission_control.h"
#include "core_stack/planning/grid_planner.h"
#include "core_stack/planning/join.h"

namespace karst::core {
namespace {

bool near_line(const std::vector<Vec3>& line, const Vec3& place) {
  for (std::size_t i = 0; i < line.size(); ++i)
    if (near_narrow_place({place}, line[i], line[std::min(i + 1, line.size() - 1)])) return true;
  return false;
}

}  // namespace

MissionControl::Route MissionControl::route(const Flight::Onward& lead, const Path& path,
                                            const std::optional<Goal>& goal,
                                            const std::optional<Goal>& passed, TimeNs start,
                                            double most_cut_m, const MotionLimits& within,
                                            const std::vector<Vec3>& narrow_before) const {
  Route out;
  out.path = path;
  const auto clear = [&, usual_m = options_.planning.clearance_m](const Vec3& a, const Vec3& b) {
    return segment_clear(explorer_.map(), a, b, usual_m) ||
           (near_narrow_place(path.narrow_places, a, b) &&
            segment_clear(explorer_.map(), a, b, path.clear_by_m));
  };
  out.points = join_paths(lead.points, path.points, most_cut_m, clear);
  out.heading.along_path = !description_.lidar;
  out.heading.start_heading_rad = lead.heading_rad;
  if (goal && std::isfinite(goal->heading_rad)) out.heading.goal_heading_rad = goal->heading_rad;
  // A vehicle that sees all around sees what the passed goal is for anyway.
  if (out.heading.along_path && passed && std::isfinite(passed->heading_rad))
    out.heading.passing = {passed->position, passed->heading_rad};
  out.start_speed_mps = lead.speed_mps;
  out.max_speed_mps = goal && goal->max_speed_mps > 0 ? goal->max_speed_mps : options_.motion.max_speed_mps;
  // The lead may still lead through the narrow places of the path before.
  out.slow = {path.narrow_places, kNarrowReach_m, options_.safety.slow_share * options_.motion.max_speed_mps};
  for (const Vec3& place : narrow_before)
    if (near_line(lead.points, place)) out.slow.places.push_back(place);
  if (options_.motion.trajectory == "polynomial" && path.found() && path.escape_points == 0 &&
      out.slow.places.empty()) {
    MotionLimits limits = within;
    limits.max_speed_mps = std::min(limits.max_speed_mps, out.max_speed_mps);
    out.polynomial = polynomial_trajectory(out.points, lead.departure, start, limits, out.heading, clear);
  }
  out.limits = slowed(within, out.max_speed_mps);
  if (!out.polynomial || !out.polynomial->fell_back.empty())
    out.sampled = sample_trajectory(out.points, out.start_speed_mps, 0, out.limits, out.heading, out.slow);
  return out;
}

void MissionControl::follow(const Route& way) {
  // Made for the state it was expected to be in now, and the speed allowed then: either may have changed.
  const auto& polynomial = way.polynomial;
  const bool fits = polynomial && polynomial->fell_back.empty() && polynomial->trajectory.start == now() &&
                    (flight_.expected(now()).position - way.points.front()).norm() < 0.01 &&
                    flight_.limits(0).max_speed_mps >= polynomial->speed_limit_mps;
  nlohmann::json points = nlohmann::json::array();
  for (const Vec3& p : way.points) points.push_back({p.x(), p.y(), p.z()});
  nlohmann::json plan{{"length", path_length_m(way.points)},
                      {"from", points.front()},
                      {"to", points.back()},
                      {"narrow", way.path.narrow()},
                      {"length_bound", way.path.length_bound},
                      {"points", points}};
  if (options_.motion.trajectory == "polynomial") {
    plan["trajectory"] = fits ? "polynomial" : "sampled";
    plan["rounds"] = polynomial ? polynomial->rounds : 0;
    plan["fell_back"] = fits                             ? ""
                        : !polynomial                    ? "a way back as come, or through a tight place"
                        : !polynomial->fell_back.empty() ? polynomial->fell_back
                                                         : "the motion has changed since it was made";
  }
  recorder_.event(now(), "plan", plan);
  const double start_speed_mps = flight_.at_rest(now()) ? 0.0 : way.start_speed_mps;
  const bool still_so = !way.sampled.samples.empty() && start_speed_mps == way.start_speed_mps &&
                        flight_.limits(way.max_speed_mps) == way.limits;
  Trajectory sampled = way.sampled;
  sampled.start = now();
  flight_.follow(way.points, start_speed_mps, now(), way.heading, way.max_speed_mps, way.slow,
                 fits       ? &polynomial->trajectory
                 : still_so ? &sampled
                            : nullptr);
  narrow_places_ = way.slow.places;
  path_limited_ = way.max_speed_mps < options_.motion.max_speed_mps;
  const Path& path = way.path;
  tight_until_ =
      path.escape_points == 0
          ? 0
          : flight_.time_nearest(path.points[std::min(path.escape_points, path.points.size() - 1)]);
  path_blocked_ = detour_due_ = false;
}

}  // namespace karst::core
