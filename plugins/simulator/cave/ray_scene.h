// Ray casts and closest points on a triangle mesh, and on boulders that may appear and move.
//
// Embree 3 finds the triangles that a ray may hit; ranges are computed here. Embree's own ranges come from
// approximate reciprocals (rcpps), which differ between processor vendors, and from fused multiply-adds where
// the processor has them.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::cave {

struct Ray {
  core::Vec3f origin, direction;  // direction of unit length
};

struct Hit {
  float range_m = std::numeric_limits<float>::infinity();  // infinity: no hit within the maximum range
  std::uint32_t triangle = 0;                              // index in the mesh, or kBoulder
  core::Vec3f normal = core::Vec3f::Zero();                // unit, on the side the ray came from
  bool any() const { return range_m < std::numeric_limits<float>::infinity(); }
};

constexpr std::uint32_t kBoulder = ~std::uint32_t{0};

/// A ball of rock. There are few, so each is tested in turn, in closed form.
struct Sphere {
  core::Vec3 centre = core::Vec3::Zero();
  double radius_m = 1;
};

/// The rock nearest to a point. If none is within the search radius, the distance is that radius.
struct Nearest {
  double distance_m = 0;
  core::Vec3 point = core::Vec3::Zero();
  bool found = false;
};

/// A value: copies share the mesh. All queries are const and may run on several threads at once. Results
/// depend on the rock and the query only: they are bit-identical on every processor and in any packet.
class RayScene {
 public:
  explicit RayScene(TriangleMesh mesh);
  /// The same mesh with these boulders and no others.
  RayScene with_boulders(std::vector<Sphere> boulders) const;

  const TriangleMesh& mesh() const { return *mesh_; }
  const std::vector<Sphere>& boulders() const { return boulders_; }

  /// `out[i]` is the first hit of `rays[i]`; of triangles hit at the same range, the first of the mesh.
  /// Consecutive rays should have similar directions: they are cast in packets of eight.
  void cast(std::span<const Ray> rays, float max_range_m, std::span<Hit> out) const;
  Hit cast(const Ray& ray, float max_range_m) const;

  /// Range to rock from `from` along `direction` (of any length), or infinity.
  double ray_cast(const core::Vec3& from, const core::Vec3& direction, double max_range_m) const;
  /// Ranges at which the ray crosses surfaces of the mesh, ascending; surfaces closer together than 0.1 mm
  /// count once.
  std::vector<double> surfaces(const Ray& ray) const;
  int crossings(const Ray& ray) const { return static_cast<int>(surfaces(ray).size()); }

  Nearest nearest(const core::Vec3& p, double within_m) const;
  double distance_to_rock(const core::Vec3& p, double within_m) const {
    return nearest(p, within_m).distance_m;
  }

 private:
  struct Handles;
  std::shared_ptr<const TriangleMesh> mesh_;
  std::shared_ptr<const Handles> handles_;
  std::vector<Sphere> boulders_;
};

}  // namespace karst::cave
