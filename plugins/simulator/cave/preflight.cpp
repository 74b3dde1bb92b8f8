#include "plugins/simulator/cave/preflight.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core_stack/common/decimal_text.h"
#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "plugins/simulator/cave/boundary_loops.h"

namespace karst::cave {

using core::decimal_text;
using core::format_text;
using core::InputError;
using core::Vec3;
using core::Vec3f;

Surroundings look_around(const RayScene& scene, const Vec3& place, int rays) {
  Surroundings s;
  s.clearance_m = scene.distance_to_rock(place, 100.0);
  int escaped = 0, odd = 0;
  for (int i = 0; i < rays; ++i) {
    // Fibonacci lattice: equal areas on the sphere.
    const double z = 1 - (2 * i + 1.0) / rays, r = std::sqrt(1 - z * z);
    const double azimuth = 2 * std::numbers::pi * i / std::numbers::phi;
    const Vec3 d(r * std::cos(azimuth), r * std::sin(azimuth), z);
    const int n = scene.crossings({place.cast<float>(), d.cast<float>()});
    odd += n % 2;
    if (n > 0) continue;
    ++escaped;
    s.escape_direction += d;
  }
  s.escape_fraction = static_cast<double>(escaped) / rays;
  s.odd_fraction = static_cast<double>(odd) / rays;
  if (escaped > 0 && s.escape_direction.norm() > 0) s.escape_direction.normalize();
  return s;
}

namespace {

/// "outside of the cave (12 % of its rays pass ...)" of a place most of whose rays pass an even number of
/// surfaces.
std::string not_inside_text(const Surroundings& s) {
  return format_text(
      "%s (%.0f %% of its rays pass an odd number of surfaces; from a place inside the cave, most do)",
      s.escape_fraction > 0.25 ? "outside of the cave" : "inside rock", 100 * s.odd_fraction);
}

}  // namespace

void check_start(const Cave& cave, double vehicle_radius_m) {
  const CaveDescription& d = cave.description;
  const Surroundings s = look_around(cave.scene, d.start.position);
  const auto refuse = [&](const std::string& reason) { throw InputError(d.file, "start", reason); };
  const Vec3& p = d.start.position;
  const std::string place = "(" + decimal_text(p, 2) + ")";
  if (s.clearance_m < vehicle_radius_m)
    refuse(place + format_text(" is %.2f m from rock; the vehicle's radius is %.2f m", s.clearance_m,
                               vehicle_radius_m));
  if (s.odd_fraction < 0.5) refuse(place + " is " + not_inside_text(s));
  if (s.escape_fraction > kPinholes) {
    const auto& e = s.escape_direction;
    refuse(format_text("the mesh has a hole here: %.2f %% of the rays from %s escape, about (%s)",
                       100 * s.escape_fraction, place.c_str(), decimal_text(e, 2).c_str()) +
           hole_text(loop_towards(boundary_loops(cave.scene.mesh()), p, e)));
  }
}

std::optional<Resting> lowered_sphere(const RayScene& scene, const Vec3& from, double radius_m) {
  constexpr double kDeepest_m = 3, kTouch_m = 1e-4;
  for (Vec3 p = from; from.z() - p.z() <= kDeepest_m;) {
    const Nearest n = scene.nearest(p, kDeepest_m + 2 * radius_m);
    const double gap_m = n.distance_m - radius_m;
    if (gap_m <= kTouch_m) return Resting{p, n};
    p.z() -= std::max(gap_m, kTouch_m);
  }
  return std::nullopt;
}

void lay_objects(Cave& cave) {
  constexpr double kMin_m = 0.02, kLiesOn_m = 1;
  for (CaveObject& o : cave.description.objects) {
    const auto refuse = [&](const std::string& reason) {
      throw InputError(cave.description.file, "object.position", reason);
    };
    const Vec3& p = o.position;
    const Surroundings s = look_around(cave.scene, p);
    if (s.odd_fraction < 0.5)
      refuse(format_text("the %s at (%s) is ", core::name_of(o.kind), decimal_text(p, 2).c_str()) +
             not_inside_text(s));
    const Nearest rock = cave.scene.nearest(p, kLiesOn_m);
    if (rock.found && rock.distance_m < kMin_m)
      refuse(format_text("the %s at (%s) is %.3f m from rock: its middle must be 0.02 m off at least",
                         core::name_of(o.kind), decimal_text(p, 2).c_str(), rock.distance_m));
    o.normal = rock.found ? Vec3((p - rock.point).normalized()) : Vec3(Vec3::Zero());
  }
}

void check_climb(const Cave& cave, const Vec3& standing, double climb_m, double vehicle_radius_m) {
  constexpr double kAir_m = 0.1, kStep_m = 0.01;
  constexpr double kRounding_m = 1e-3;  // where it stands it touches the floor
  for (double risen_m = 0; climb_m > 0 && risen_m < climb_m + kAir_m; risen_m += kStep_m) {
    const Vec3 p = standing + Vec3(0, 0, risen_m);
    const Nearest rock = cave.scene.nearest(p, vehicle_radius_m);
    if (rock.distance_m > vehicle_radius_m - kRounding_m) continue;
    throw InputError(
        cave.description.file, "start",
        format_text(
            "from the floor below it, at (%s), the vehicle can rise by %.2f m only: rock is in the way at "
            "(%s). The first hover is %.2f m up: start elsewhere or hover lower",
            decimal_text(standing, 2).c_str(), std::max(risen_m - kAir_m, 0.0),
            decimal_text(rock.point, 2).c_str(), climb_m));
  }
}

}  // namespace karst::cave
