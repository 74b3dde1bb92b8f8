#include "plugins/simulator/environment/launch_site.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "plugins/simulator/dynamics/contact.h"

namespace karst::sim {

using core::Vec3;

namespace {

/// Sphere tracing straight down; the sphere comes to rest 0.1 mm or less above the floor.
std::optional<Vec3> standing_place(const cave::RayScene& scene, const Vec3& from, double radius_m) {
  constexpr double kDeepest_m = 3, kTouch_m = 1e-4;
  for (Vec3 p = from; from.z() - p.z() <= kDeepest_m;) {
    const cave::Nearest n = scene.nearest(p, kDeepest_m + 2 * radius_m);
    const double gap_m = n.distance_m - radius_m;
    if (gap_m > kTouch_m) {
      p.z() -= std::max(gap_m, kTouch_m);
      continue;
    }
    const Touch touch{n.point, (n.point - p).normalized(), 0};
    return supports(touch, Vec3::Zero()) ? std::optional(p) : std::nullopt;
  }
  return std::nullopt;
}

void add_disc(cave::TriangleMesh& mesh, const Vec3& centre, double radius_m) {
  constexpr std::uint32_t kCorners = 16;
  const auto hub = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(centre.cast<float>());
  for (std::uint32_t i = 0; i < kCorners; ++i) {
    const double a = 2 * std::numbers::pi * i / kCorners;
    mesh.vertices.push_back((centre + radius_m * Vec3(std::cos(a), std::sin(a), 0)).cast<float>());
    mesh.triangles.push_back({hub, hub + 1 + i, hub + 1 + (i + 1) % kCorners});
  }
}

}  // namespace

LaunchSite set_down(cave::Cave& cave, double radius_m) {
  const cave::StartPose& start = cave.description.start;
  const core::Quat level = core::from_heading(start.heading_rad);
  if (const auto place = standing_place(cave.scene, start.position, radius_m))
    return {{*place, level}, false};
  cave::TriangleMesh mesh = cave.scene.mesh();
  add_disc(mesh, start.position - Vec3(0, 0, radius_m), 0.5);
  cave.scene = cave::RayScene(std::move(mesh));
  return {{start.position, level}, true};
}

}  // namespace karst::sim
