// Detects whether the vehicle touches rock, and whether it then stands on it or crashes.
#pragma once
#include <optional>

#include "plugins/simulator/cave/ray_scene.h"

namespace karst::sim {

struct Touch {
  core::Vec3 place = core::Vec3::Zero();
  core::Vec3 direction = core::Vec3::Zero();  // unit, from the vehicle's centre to the rock
  double depth_m = 0;                         // penetration of the sphere into the rock
};

/// Watches the distance of the vehicle's sphere to rock. Distance changes no faster than the vehicle moves,
/// so the next query is needed only when the vehicle could have reached the rock: rarely when far from it, at
/// every step when near, and no contact is missed.
class ContactWatch {
 public:
  ContactWatch(const cave::RayScene& scene, double radius_m) : scene_(&scene), radius_m_(radius_m) {}
  /// Replaces the rock from now on.
  void watch(const cave::RayScene& scene) {
    scene_ = &scene;
    last_distance_m_ = -1;
  }
  /// The touch at this place of the vehicle's centre, if there is one.
  std::optional<Touch> touch(const core::Vec3& position);
  /// Distance of the sphere's surface to rock, looked for within 50 m.
  double clearance_m(const core::Vec3& position);
  long queries() const { return queries_; }

 private:
  cave::Nearest query(const core::Vec3& position);

  const cave::RayScene* scene_;
  double radius_m_;
  core::Vec3 last_position_ = core::Vec3::Zero();
  double last_distance_m_ = -1;  // negative: not queried yet
  long queries_ = 0;
};

/// Whether the rock carries the vehicle: it lies within 50 degrees of straight down and is met below 0.8 m/s.
bool supports(const Touch& touch, const core::Vec3& velocity_mps);
/// Angle between the direction of the touch and straight down.
double angle_from_down_rad(const Touch& touch);

}  // namespace karst::sim
