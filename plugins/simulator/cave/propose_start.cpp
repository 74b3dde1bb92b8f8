#include "plugins/simulator/cave/propose_start.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "plugins/simulator/cave/air_columns.h"
#include "plugins/simulator/cave/preflight.h"

namespace karst::cave {

using core::Vec3;

namespace {

struct StartPlace {
  Vec3 position = Vec3::Zero(), standing = Vec3::Zero();
  double score = 0;
};

/// As start_text() prints it.
double to_centimetres(double v_m) { return std::round(v_m * 100) / 100 + 0.0; }

/// Whether the floor around is as high as below the place, to a quarter of a metre.
bool is_level_around(const RayScene& scene, const Vec3& place, double height_m) {
  constexpr int kAround = 8;
  constexpr double kRing_m = 0.4, kStep_m = 0.25;
  for (int i = 0; i < kAround; ++i) {
    const double a = 2 * std::numbers::pi * i / kAround;
    const Vec3 p = place + kRing_m * Vec3(std::cos(a), std::sin(a), 0);
    if (std::abs(scene.ray_cast(p, -Vec3::UnitZ(), height_m + 1) - height_m) > kStep_m) return false;
  }
  return true;
}

std::optional<StartPlace> place_in(const RayScene& scene, const AirColumn& column, const StartNeeds& needs) {
  constexpr double kHigh_m = 1.2, kEnoughRoom_m = 2, kFar_m = 1e4;
  if (column.height_m < needs.air_m) return std::nullopt;
  const Vec3 middle(to_centimetres(column.floor.x()), to_centimetres(column.floor.y()),
                    column.floor.z() + column.height_m / 2);
  const double down_m = scene.ray_cast(middle, -Vec3::UnitZ(), kFar_m),
               air_m = down_m + scene.ray_cast(middle, Vec3::UnitZ(), kFar_m);
  if (air_m < needs.air_m || air_m > kFar_m) return std::nullopt;
  StartPlace place;
  place.position = middle;
  place.position.z() = to_centimetres(middle.z() - down_m + std::min(kHigh_m, air_m / 2));
  const double room_m = scene.distance_to_rock(place.position, kEnoughRoom_m);
  if (room_m < needs.clearance_m) return std::nullopt;
  const std::optional<Resting> rest = lowered_sphere(scene, place.position, needs.vehicle_radius_m);
  if (!rest) return std::nullopt;
  place.standing = rest->centre;
  const Vec3 up = (rest->centre - rest->rock.point).normalized();
  const double slope_rad = std::acos(std::clamp(up.z(), -1.0, 1.0));
  const double height_m = place.position.z() - (middle.z() - down_m);
  if (slope_rad > needs.max_slope_rad || !is_level_around(scene, place.position, height_m))
    return std::nullopt;
  place.score = room_m - slope_rad;
  return place;
}

bool can_climb(const RayScene& scene, const Vec3& standing, const StartNeeds& needs) {
  try {
    check_climb({{}, scene}, standing, needs.climb_m, needs.vehicle_radius_m);
    return true;
  } catch (const core::InputError&) {
    return false;
  }
}

/// The whole ten degrees with the longest sight.
double heading_of_longest_sight(const RayScene& scene, const Vec3& from) {
  constexpr int kHeadings = 36;
  constexpr double kFar_m = 100;
  double best_rad = 0, longest_m = -1;
  for (int i = 0; i < kHeadings; ++i) {
    const double a = 2 * std::numbers::pi * i / kHeadings;
    const double sight_m = std::min(kFar_m, scene.ray_cast(from, {std::cos(a), std::sin(a), 0}, kFar_m));
    if (sight_m <= longest_m) continue;
    longest_m = sight_m;
    best_rad = a;
  }
  return best_rad;
}

}  // namespace

std::optional<StartPose> propose_start(const RayScene& scene, const StartNeeds& needs) {
  constexpr int kLines = 1000;
  constexpr std::size_t kTried = 40;
  std::vector<StartPlace> places;
  for (const AirColumn& column : air_columns(scene, kLines))
    if (const auto place = place_in(scene, column, needs)) places.push_back(*place);
  std::stable_sort(places.begin(), places.end(),
                   [](const StartPlace& a, const StartPlace& b) { return a.score > b.score; });
  std::optional<Vec3> in_sight_of_hole;
  for (std::size_t i = 0; i < places.size() && i < kTried; ++i) {
    const Vec3& p = places[i].position;
    const Surroundings s = look_around(scene, p);
    if (s.odd_fraction < 0.5 || !can_climb(scene, places[i].standing, needs)) continue;
    if (s.escape_fraction <= kPinholes) return StartPose{p, heading_of_longest_sight(scene, p)};
    if (!in_sight_of_hole) in_sight_of_hole = p;
  }
  if (!in_sight_of_hole) return std::nullopt;
  return StartPose{*in_sight_of_hole, heading_of_longest_sight(scene, *in_sight_of_hole)};
}

std::optional<StartPose> start_among(const RayScene& scene, const std::vector<Vec3>& places,
                                     const StartNeeds& needs) {
  constexpr double kFar_m = 1000;
  for (const Vec3& p : places) {
    const double down_m = scene.ray_cast(p, -Vec3::UnitZ(), kFar_m),
                 up_m = scene.ray_cast(p, Vec3::UnitZ(), kFar_m);
    if (!std::isfinite(down_m + up_m)) continue;
    const auto place = place_in(scene, {p - down_m * Vec3::UnitZ(), down_m + up_m}, needs);
    if (!place) continue;
    const Surroundings s = look_around(scene, place->position);
    if (s.odd_fraction < 0.5 || s.escape_fraction > kPinholes || !can_climb(scene, place->standing, needs))
      continue;
    return StartPose{place->position, heading_of_longest_sight(scene, place->position)};
  }
  return std::nullopt;
}

std::string start_text(const StartPose& s) {
  const Vec3& p = s.position;
  return core::format_text("%.2f %.2f %.2f %.0f", p.x(), p.y(), p.z(),
                           s.heading_rad * 180 / std::numbers::pi);
}

}  // namespace karst::cave
