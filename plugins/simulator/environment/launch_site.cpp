#include "plugins/simulator/environment/launch_site.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "plugins/simulator/cave/preflight.h"
#include "plugins/simulator/dynamics/contact.h"

namespace karst::sim {

using core::Vec3;

namespace {

/// None if there is no floor near below, or one too steep to stand on.
std::optional<Vec3> standing_place(const cave::RayScene& scene, const Vec3& from, double radius_m) {
  const std::optional<cave::Resting> rest = cave::lowered_sphere(scene, from, radius_m);
  if (!rest) return std::nullopt;
  const Touch touch{rest->rock.point, (rest->rock.point - rest->centre).normalized(), 0};
  return supports(touch, Vec3::Zero()) ? std::optional(rest->centre) : std::nullopt;
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
