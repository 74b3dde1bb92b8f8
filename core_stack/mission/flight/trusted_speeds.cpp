#include "core_stack/mission/flight/trusted_speeds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core_stack/mission/flight/flight.h"
#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/free_space/free_way.h"
#include "core_stack/planning/path/path.h"

namespace karst::core {
namespace {

/// A pose of LOAM comes so long after its sweep: the sensor's own delay, and the localization's budget.
constexpr double kLocating_s = 0.08;
/// Of the clearance: how far beside the path a rock on it is seen.
constexpr double kAside = 0.8;
/// FreeTiles looks no farther for the nearest obstacle.
constexpr double kFarthest_cells = 15;

/// The scans after which a cell that was as free as can be is occupied.
int scans_until_occupied(const MapOptions& o) {
  const auto log_odds = [](double p) { return std::log(p / (1 - p)); };
  return static_cast<int>(std::floor(-log_odds(o.min_probability) / log_odds(o.hit_probability))) + 1;
}

double pitch_rad(const Vec3& direction) {
  return std::atan2(direction.z(), std::hypot(direction.x(), direction.y()));
}

bool senses(const SensedAhead& sensed, const Vec3& offset) {
  const double distance_m = offset.norm(), pitch = pitch_rad(offset);
  return std::any_of(sensed.bands.begin(), sensed.bands.end(), [&](const SensedAhead::Band& b) {
    return distance_m <= b.range_m && pitch >= b.low_rad && pitch <= b.high_rad;
  });
}

/// Whether a rock that leaves no way past `to` would be in sight from `from`: its middle, or a side of it.
bool in_sight(const VoxelMap& map, const Vec3& from, const Vec3& to, double aside_m) {
  const Vec3 along = (to - from).normalized(),
             across = along.cross(std::abs(along.z()) > 0.9 ? Vec3::UnitX() : Vec3::UnitZ()).normalized(),
             up = across.cross(along);
  const Vec3 sides[] = {Vec3::Zero(), across, -across, up, -up};
  return std::any_of(std::begin(sides), std::end(sides),
                     [&](const Vec3& side) { return sees(map, from, to + aside_m * side); });
}

/// Points of the path from its end back to its start, `spacing_m` apart; the last one may be beyond.
std::vector<Vec3> from_the_end(const std::vector<Vec3>& points, double spacing_m) {
  std::vector<Vec3> out{points.back()};
  double next_m = spacing_m;
  for (std::size_t i = points.size() - 1; i-- > 0;) {
    const Vec3 step = points[i] - points[i + 1];
    const double length_m = step.norm();
    for (; next_m <= length_m; next_m += spacing_m) out.push_back(points[i + 1] + step * (next_m / length_m));
    next_m -= length_m;
  }
  out.push_back(points.front());
  return out;
}

}  // namespace

double SensedAhead::range_m() const {
  double most_m = 0;
  for (const Band& b : bands)
    if (b.low_rad <= 0 && b.high_rad >= 0) most_m = std::max(most_m, b.range_m);
  return most_m;
}

SensedAhead sensed_ahead(const CoreOptions& options, const VehicleDescription& vehicle) {
  SensedAhead out;
  TimeNs period = 0;
  if (const auto& lidar = vehicle.lidar; lidar && !lidar->elevation_rad.empty()) {
    const auto [low, high] = std::minmax_element(lidar->elevation_rad.begin(), lidar->elevation_rad.end());
    // A tilted LiDAR sees these elevations in every direction. One that hangs sees the opposite ones.
    const double up = pitch_rad(lidar->T_body_lidar.orientation * Vec3::UnitZ()),
                 tilt = std::numbers::pi / 2 - std::abs(up);
    const SensedAhead::Band band{std::min<double>(lidar->max_range_m, options.mission.mapping_range_m),
                                 (up >= 0 ? *low : -*high) + tilt, (up >= 0 ? *high : -*low) - tilt};
    if (band.low_rad <= band.high_rad) out.bands.push_back(band);
    period = lidar->period;
  }
  // Only a vehicle without LiDAR turns to where it flies.
  for (const auto& camera : vehicle.cameras) {
    const Vec3 axis = camera->T_body_camera.orientation * Vec3::UnitX();
    const bool looks_ahead = std::abs(std::atan2(axis.y(), axis.x())) < camera->horizontal_fov_rad / 2;
    if (vehicle.lidar || !looks_ahead) continue;
    const double pitch = pitch_rad(axis), half = camera->vertical_fov_rad / 2;
    out.bands.push_back({camera->max_range_m, pitch - half, pitch + half});
    period = std::max(period, camera->period);
  }
  // In the worst case a beam has just passed by: the first hit is then in the next sweep but one.
  // No decision is needed to brake, but until the vehicle does, jerk takes half of the time of building up.
  out.reaction_s = (scans_until_occupied(options.map) + 1) * seconds(period) + seconds(kMappingBudget) +
                   options.motion.max_acceleration_mps2 / (2 * options.motion.max_jerk_mps3);
  if (options.localization.source == PoseSource::lidar) out.reaction_s += kLocating_s;
  return out;
}

double slow_speed_mps(const CoreOptions& options) {
  return options.safety.slow_fraction * std::min(options.motion.max_speed_mps, kTrusted_mps);
}

CoreOptions as_flown(CoreOptions options, const VehicleDescription& vehicle) {
  MotionLimits& motion = options.motion;
  if (by_trust(motion)) {
    const double braking_mps2 = kBrakingFraction * with_room_to_catch_up(motion).max_acceleration_mps2;
    motion.max_speed_mps = std::min(
        motion.max_speed_mps, open_space_speed_mps(options, sensed_ahead(options, vehicle), braking_mps2));
    // Polynomials and plans of the receding horizon do not keep limits that differ along a path.
    motion.trajectory = TrajectoryKind::sampled;
  }
  return options;
}

bool by_trust(const MotionLimits& motion) { return motion.max_speed_mps > kTrusted_mps; }

double open_space_speed_mps(const CoreOptions& options, const SensedAhead& sensed, double braking_mps2) {
  return std::max(kTrusted_mps, stopping_speed_mps(sensed.range_m() - options.planning.clearance_m,
                                                   sensed.reaction_s, braking_mps2));
}

TrustedSpeeds trusted_speeds(const VoxelMap& map, const CoreOptions& options,
                             const VehicleDescription& vehicle, const std::vector<Vec3>& points,
                             double braking_mps2) {
  TrustedSpeeds out;
  if (!by_trust(options.motion) || points.empty()) return out;
  const SensedAhead sensed = sensed_ahead(options, vehicle);
  const std::vector<Vec3> place = from_the_end(points, out.spacing_m);
  const double half_cell_m = map.resolution_m() / 2,
               open_mps = open_space_speed_mps(options, sensed, braking_mps2);
  const double enough_m = std::min(vehicle.radius_m + half_cell_m + kGapTime_s * options.motion.max_speed_mps,
                                   (kFarthest_cells - 1) * map.resolution_m());
  FreeTiles free(map.resolution_m());
  const double aside_m = kAside * options.planning.clearance_m;
  const auto seen = [&](std::size_t from, std::size_t to) {
    return from == to ||
           (senses(sensed, place[to] - place[from]) && in_sight(map, place[from], place[to], aside_m));
  };
  out.sight_mps.resize(place.size());
  out.room_mps.resize(place.size());
  // From the start on: what is in sight from one place mostly is from the next, and a little more.
  std::size_t farthest = place.size() - 1;
  for (std::size_t i = place.size(); i-- > 0;) {
    farthest = std::min(farthest, i);
    while (!seen(i, farthest)) ++farthest;
    while (farthest > 0 && seen(i, farthest - 1)) --farthest;
    // Where the end is in sight nothing is hidden before it.
    const double seen_m =
        farthest == 0 ? sensed.range_m() : static_cast<double>(i - farthest) * out.spacing_m;
    out.sight_mps[i] =
        std::clamp(stopping_speed_mps(seen_m - options.planning.clearance_m, sensed.reaction_s, braking_mps2),
                   kTrusted_mps, open_mps);
    free.load_near(map, place[i], enough_m);
    const double near_m = free.nearest(place[i], enough_m).distance_m;
    out.room_mps[i] =
        near_m >= enough_m
            ? std::numeric_limits<double>::infinity()
            : std::max(kTrusted_mps, speed_beside_rock_mps(near_m - vehicle.radius_m - half_cell_m));
  }
  return out;
}

}  // namespace karst::core
