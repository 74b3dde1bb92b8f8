#include "plugins/simulator/environment/object_placing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "core_stack/common/error.h"
#include "core_stack/common/random.h"

namespace karst::sim {

using core::Random;
using core::Vec3;

void describe(core::OptionTable& t, ObjectOptions& o) {
  t.add("count", o.count, 0, 200, "objects of interest that the seed lays out in the cave, beside its own");
  t.add("on", o.on, "where: on ground no steeper than 45 degrees, or on any rock");
  t.add("range", o.range_m, "m", 0.5, 30,
        "objects farther from a camera, or out of its own range, are not recognized");
  t.add("max_incidence", o.max_incidence_rad, "rad", 0.1, 1.55,
        "nor are those seen more at a slant to the rock they lie on");
  t.add("detection", o.detection, "", 0, 1,
        "share of images with an object in view in which it is recognized");
  t.add("false_per_minute", o.false_per_min, "", 0, 600, "detections of what is no object, for each camera");
  t.add("bearing_noise", o.bearing_noise_rad, "rad", 0, 0.5, "deviation of the direction, in each axis");
  t.add("depth_noise", o.depth_noise, "", 0, 1,
        "deviation of a depth camera's range to it, as a share of it");
  t.add("size_noise", o.size_noise, "", 0, 1,
        "the same of a colour camera, which knows the range by the object's size only");
  t.add("delay", o.delay_s, "s", 0, 1.5, "from the image to the detection");
}

namespace {

constexpr double kStep_m = 0.3, kFarthest_m = 4.0, kApart_m = 4.0;
constexpr double kOffRock_m = 0.15;  // distance of an object's centre from the rock
constexpr std::size_t kMaxPlaces = 500000;

Vec3 any_direction(Random& random) {
  const double z = random.uniform(-1, 1), r = std::sqrt(1 - z * z),
               a = random.uniform(0, 2 * std::numbers::pi);
  return {r * std::cos(a), r * std::sin(a), z};
}

}  // namespace

std::vector<Vec3> flyable_places(const cave::Cave& cave, double clearance_m) {
  using Step = std::array<int, 3>;
  // Balls of the clearance around two neighbours cover the segment between them.
  const double step_m = std::min(kStep_m, clearance_m);
  const Vec3& start = cave.description.start.position;
  std::vector<Vec3> places{start};
  std::vector<Step> steps{{0, 0, 0}};
  std::set<Step> known{steps.front()};
  for (std::size_t next = 0; next < places.size() && places.size() < kMaxPlaces; ++next)
    for (int i = 0; i < 6; ++i) {
      Step there = steps[next];
      there[static_cast<std::size_t>(i / 2)] += i % 2 == 0 ? 1 : -1;
      if (!known.insert(there).second) continue;
      const Vec3 p = start + step_m * Vec3(there[0], there[1], there[2]);
      if (cave.scene.distance_to_rock(p, clearance_m) < clearance_m) continue;
      places.push_back(p);
      steps.push_back(there);
    }
  return places;
}

void place_objects(cave::Cave& cave, const ObjectOptions& o, std::uint64_t seed) {
  if (o.count == 0) return;
  constexpr double kMinCosine = 0.5, kFloor = 0.7071;
  constexpr int kTriesEach = 2000;
  Random random = Random::stream(seed, "objects");
  const std::vector<Vec3> places = flyable_places(cave);
  std::vector<cave::CaveObject>& objects = cave.description.objects;
  const auto own = static_cast<std::int64_t>(objects.size());
  const auto apart = [&](const Vec3& p) {
    return (p - cave.description.start.position).norm() >= kApart_m &&
           std::all_of(objects.begin(), objects.end(),
                       [&](const auto& other) { return (other.position - p).norm() >= kApart_m; });
  };
  for (std::int64_t tries = o.count * kTriesEach;
       tries > 0 && static_cast<std::int64_t>(objects.size()) < own + o.count; --tries) {
    const Vec3& eye = places[static_cast<std::size_t>(random.uniform() * static_cast<double>(places.size()))];
    const Vec3 d = any_direction(random);
    const auto kind =
        static_cast<core::ObjectKind>(1 + static_cast<int>(random.uniform() * core::kObjectKinds));
    const cave::Hit hit =
        cave.scene.cast({eye.cast<float>(), d.cast<float>()}, static_cast<float>(kFarthest_m));
    if (!hit.any()) continue;
    const Vec3 normal = hit.normal.cast<double>();
    if (-normal.dot(d) < kMinCosine || (o.on == PlacedOn::floor && normal.z() < kFloor)) continue;
    const Vec3 p = eye + static_cast<double>(hit.range_m) * d + kOffRock_m * normal;
    const double distance_m = (p - eye).norm();
    if (!apart(p) || cave.scene.distance_to_rock(p, kOffRock_m) < 0.5 * kOffRock_m ||
        cave.scene.ray_cast(eye, p - eye, distance_m) < distance_m)
      continue;
    objects.push_back({kind, p, normal});
  }
  if (const auto placed = static_cast<std::int64_t>(objects.size()) - own; placed < o.count)
    throw core::InputError(cave.description.file, "simulator.objects.count",
                           "there is room for " + std::to_string(placed) + " objects " +
                               std::to_string(static_cast<int>(kApart_m)) +
                               " m apart where a vehicle can see them, not for " + std::to_string(o.count));
}

}  // namespace karst::sim
