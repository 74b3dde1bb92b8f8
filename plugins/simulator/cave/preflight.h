// Checks before the flight whether the start pose is suitable, and gives a reason if it is not.
#pragma once
#include <optional>

#include "plugins/simulator/cave/cave.h"

namespace karst::cave {

/// Results of rays cast in all directions from one position.
struct Surroundings {
  double clearance_m = 0;                            // distance to rock, at most 100 m
  double escape_fraction = 0;                        // of rays that meet no rock at all
  core::Vec3 escape_direction = core::Vec3::Zero();  // mean direction of those rays
  double odd_fraction = 0;                           // of rays that pass an odd number of surfaces
};
Surroundings look_around(const RayScene& scene, const core::Vec3& place, int rays = 4096);

/// Share of rays that may slip between triangles that do not quite join: 2 of 4096.
constexpr double kPinholes = 0.0005;

/// Throws InputError if the vehicle's sphere does not fit at the start pose, if the place is not inside the
/// cave, or if the mesh has a hole there: a ray escapes without meeting rock.
///
/// Meshes of caves are seldom watertight and their winding is arbitrary, so normals are not used. A position
/// counts as inside if most of 4096 rays cross an odd number of surfaces: overlapping tiles spoil some
/// directions (16 to 22 % at the start of the SubT caves), never most of them. A boulder inside the cave adds
/// two crossings and changes nothing, while from inside the boulder the number is even. A rock surface that
/// is modelled twice, as a shell with thickness, would be refused.
void check_start(const Cave& cave, double vehicle_radius_m);

/// Finds the rock that each object of the cave lies on: the nearest rock, if it is within 1 m. Throws
/// InputError if an object lies in rock or outside the cave, or touches rock: with its centre nearer than
/// 2 cm it could not be seen.
void lay_objects(Cave& cave);

/// A sphere that has come to rest on rock, and the rock that it touches.
struct Resting {
  core::Vec3 centre = core::Vec3::Zero();
  Nearest rock;
};
/// Sphere tracing straight down, at most 3 m; the sphere comes to rest 0.1 mm or less above the rock.
std::optional<Resting> lowered_sphere(const RayScene& scene, const core::Vec3& from, double radius_m);

/// Throws InputError if the vehicle's sphere, `standing` with its centre there, cannot rise straight up by
/// `climb_m` and have 0.1 m of air left above: a ceiling or a block is in the way.
void check_climb(const Cave& cave, const core::Vec3& standing, double climb_m, double vehicle_radius_m);

}  // namespace karst::cave
